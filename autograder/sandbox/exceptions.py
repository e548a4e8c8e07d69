"""What can go wrong while a program is brought into its sandbox."""

from __future__ import annotations

from autograder.exceptions import GraderError


class ZygoteError(GraderError):
    """A program could not be forked into its sandbox. It has not run a single line, and can be started instead."""
