"""A hand-in, and which of a student's counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from autograder.result.model import Status


@dataclass(frozen=True)
class Mark:
    """The outcome of a grading."""

    status: Status
    points: float
    max_points: float


@dataclass(frozen=True)
class HandIn:
    """A student's submission: its number, which counts arrivals from 1, and its mark once it is graded."""

    number: int
    student: str
    assignment: str
    at: datetime
    mark: Mark | None = None

    @property
    def costs_a_try(self) -> bool:
        """Whether it is one of a day's tries. Where the grader failed, the student has it back."""
        return self.mark is None or self.mark.status is not Status.NOT_GRADED


def counting(own: Sequence[HandIn], *, best: bool) -> HandIn | None:
    """Return which of a student's hand-ins of an assignment counts, None if none has a mark yet.

    Args:
        own: the student's, in the order in which they came.
        best: whether the best one counts, and the later one of two equal ones; or else the last one.
    """
    graded = [(each, each.mark) for each in own if each.mark is not None and each.mark.status is Status.GRADED]
    if not graded:
        return None
    if not best:
        return graded[-1][0]
    return max(graded, key=lambda pair: (pair[1].points, pair[0].number))[0]
