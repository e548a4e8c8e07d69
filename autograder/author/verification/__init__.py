"""Tests the grader: grades submissions whose marks are known beforehand, and compares the results.

The reference gets every point of its assignment, and the untouched student release gets none. Correct answers in other
styles get every point. A named mutant fails exactly the checks in its snapshot. An attack gains no points. Of the
generated mutants that are not equivalent to the reference, at least 95 % of each chapter and 97 % of all chapters fail
a check. Each mutant that fails no check has a reason in `survivors.yaml`.
"""
