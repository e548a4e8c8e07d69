"""Checks and suites of checks."""

from autograder.suite.declaration import (
    Check,
    CheckFailed,
    CheckRow,
    Outcome,
    Visibility,
    check,
    check_each_row,
    check_of,
    expect,
    group,
    hint,
)

__all__ = [
    "Check",
    "CheckFailed",
    "CheckRow",
    "Outcome",
    "Visibility",
    "check",
    "check_each_row",
    "check_of",
    "expect",
    "group",
    "hint",
]
