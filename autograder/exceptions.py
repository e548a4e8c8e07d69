"""The errors that the grader raises, sorted by the person who can correct them.

AutograderError
├── UsageError          the command was called wrongly, or names something that does not exist  (exit status 2)
├── StudentError        the submission is wrong; it gets a diagnosis                            (points are lost)
└── GraderError         the grader or the machine failed; this is never a zero                  ("not graded")
    ├── DoubtfulError   a program or the machine failed                                         (tried again)
    └── IsolationError  this machine cannot isolate a submission as requested

`autograder.suite.CheckFailed`, a check's verdict, is also an AutograderError. `autograder.submission.reading` turns any
other exception into a StudentError while the student's data are read.
"""

from __future__ import annotations

from autograder.diagnosis import Diagnosis


class AutograderError(Exception):
    """Base class of the grader's errors."""


class UsageError(AutograderError):
    """An argument is wrong: an assignment or a file does not exist, or an option cannot be read."""


class StudentError(AutograderError):
    """The submission is wrong. `diagnosis` tells the student how to correct it."""

    def __init__(self, diagnosis: Diagnosis) -> None:
        super().__init__(diagnosis.sentence)
        self.diagnosis = diagnosis


class GraderError(AutograderError):
    """The grader failed. The submission is "not graded", which is not a zero."""


class DoubtfulError(GraderError):
    """A program or the machine failed, and it is unclear which. The grading is repeated.

    In the last attempt, the program is blamed, with this diagnosis: the machine is unlikely to fail each time.
    """

    def __init__(self, diagnosis: Diagnosis) -> None:
        super().__init__(diagnosis.sentence)
        self.diagnosis = diagnosis


class IsolationError(GraderError):
    """The machine lacks what the requested isolation needs."""
