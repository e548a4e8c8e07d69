"""Tests the grader: grades submissions whose marks are known beforehand, and compares the results.

The reference has every point of its assignment, and the untouched release has none. Right answers in another style have
every point. A named mutant loses the checks that it names and no other. An attack gains no point. Some generated
mutants are equivalent to the reference. Of the others, at least 95 % of each chapter and 97 % of all chapters lose a
check. Each mutant that loses none has a reason in `survivors.yaml`.
"""
