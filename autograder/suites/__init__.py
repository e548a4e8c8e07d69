"""The hidden suites: one package an assignment. Nothing of this folder is ever visible to students' code."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from autograder import suite
from autograder.checks import Check
from autograder.suite import Suite

__all__ = ["FOLDER", "Suite", "graded", "load", "manifest"]

FOLDER = Path(__file__).parent


@cache
def load(assignment: str) -> Suite:
    """Load the hidden suite of an assignment. Raises as `suite.read` does."""
    return suite.read(__name__, assignment)


def manifest(assignment: str) -> tuple[Check, ...]:
    """Return an assignment's hidden checks; the sum of their points is the maximum score. Raises as `load` does."""
    return load(assignment).checks


def graded() -> list[str]:
    """Return the names of the assignments that are graded."""
    return suite.names(__name__)
