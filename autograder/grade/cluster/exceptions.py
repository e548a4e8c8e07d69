"""The errors of grading on a cluster."""

from __future__ import annotations

from autograder.exceptions import GraderError


class ClusterError(GraderError):
    """The cluster cannot be reached, was lost, or lacks what it needs. What is graded by then is kept."""
