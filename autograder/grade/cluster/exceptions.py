"""The errors of grading on a cluster."""

from __future__ import annotations

from autograder.exceptions import GraderError


class ClusterError(GraderError):
    """The cluster cannot be reached, was lost, or lacks what it needs. What is graded by then is kept."""


class AnswerError(ClusterError):
    """A worker's answer breaks a bound or the schema, or its result is not of the submission that was sent."""
