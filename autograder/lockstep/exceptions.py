"""The errors of lockstep."""

from __future__ import annotations

from autograder.exceptions import StudentError
from autograder.lockstep.failures import unsteppable


class UnsteppableError(StudentError):
    """A program's time cannot be stepped; it has to be met in real time.

    Attributes:
        reason: why: thread, clock or sleep.
    """

    def __init__(self, reason: str, output: str = "") -> None:
        super().__init__(unsteppable(reason, output))
        self.reason = reason
