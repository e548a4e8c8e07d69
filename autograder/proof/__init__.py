"""Proves the grader: it grades submissions whose marks are known beforehand and compares the results.

The reference has every point of its assignment, and the untouched release has none. Right answers in another style have
every point. A named mutant loses the checks that it names and no other. A generated mutant loses at least one check. An
attack gains no point.
"""
