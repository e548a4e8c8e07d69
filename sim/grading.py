"""Detects whether a notebook runs under the grader, which displays nothing and reads only the notebook's files."""

from __future__ import annotations

import os

GRADING_VARIABLE = "AUTOGRADER_GRADING"


def grading() -> bool:
    """Return whether this process runs under the grader, which sets the environment variable."""
    return GRADING_VARIABLE in os.environ
