"""The visible checks: what a student runs in the notebook, in the form of the hidden ones.

One package an assignment. Stimuli and helpers live here, too; the hidden suites use them, never the other way round,
so that a student's machine needs none of the hidden ones.
"""

from __future__ import annotations

from functools import cache

from autograder import suite
from autograder.suite import Suite

__all__ = ["Suite", "load"]


@cache
def load(assignment: str) -> Suite:
    """Load the visible checks of an assignment. Raises as `suite.read` does."""
    return suite.read(__name__, assignment)
