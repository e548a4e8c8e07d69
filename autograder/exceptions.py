"""The grader's errors, and whose fault each one is.

AutograderError
├── UsageError          the command was called wrongly, or names something that is not there   (exit 2)
├── StudentError        the submission's own fault: a named diagnosis and a sentence to act on  (points are lost)
└── GraderError         the grader's own fault, or the machine's: never shown as a zero         ("not graded")
    └── IsolationError  this machine cannot isolate a submission as asked
"""

from __future__ import annotations

from autograder.diagnosis import Diagnosis


class AutograderError(Exception):
    """Base of every error that the grader raises on purpose."""


class UsageError(AutograderError):
    """A wrong argument: no such assignment, no such file, an unreadable option."""


class StudentError(AutograderError):
    """Something in the submission is wrong; the student can mend it.

    Attributes:
        diagnosis: what went wrong, by name and in words.
    """

    def __init__(self, diagnosis: Diagnosis) -> None:
        super().__init__(diagnosis.sentence)
        self.diagnosis = diagnosis


class GraderError(AutograderError):
    """The grader failed. The submission is "not graded", which is not a zero."""


class IsolationError(GraderError):
    """The machine lacks what the asked-for isolation needs."""
