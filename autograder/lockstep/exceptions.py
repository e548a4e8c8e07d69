"""The errors of lockstep."""

from __future__ import annotations

from autograder.exceptions import StudentError
from autograder.lockstep.failures import diagnose_unsteppable


class UnsteppableError(StudentError):
    """A program's time cannot be stepped; it has to run in real time.

    Attributes:
        reason: why, one of the protocol's `REASONS`.
    """

    def __init__(self, reason: str, output: str = "") -> None:
        super().__init__(diagnose_unsteppable(reason, output))
        self.reason = reason
