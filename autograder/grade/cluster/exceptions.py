"""The errors of grading on a cluster."""

from __future__ import annotations

from autograder.exceptions import GraderError


class ClusterError(GraderError):
    """The cluster is unreachable, was lost, or has no suitable worker. Earlier results are kept."""
