"""A student's hand-in, and the choice of the one that counts."""

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
    """A student's submission: its number in the order of arrival, from 1, its time, and its mark once it is graded."""

    number: int
    student: str
    assignment: str
    at: datetime
    mark: Mark | None = None

    @property
    def costs_a_try(self) -> bool:
        """Whether it counts as one of the day's tries, which it does not if the grader failed."""
        return self.mark is None or self.mark.status is not Status.NOT_GRADED


def counted_hand_in(hand_ins: Sequence[HandIn], *, best: bool) -> HandIn | None:
    """Return the hand-in that counts, or None if none has a mark yet.

    Args:
        hand_ins: a student's hand-ins of one assignment, in the order of their arrival.
        best: whether the best hand-in counts (the latest of equally good ones). Otherwise, the last one counts.
    """
    graded = [
        (hand_in.mark.points, hand_in)
        for hand_in in hand_ins
        if hand_in.mark is not None and hand_in.mark.status is Status.GRADED
    ]
    if not graded:
        return None
    return max(graded, key=lambda pair: (pair[0], pair[1].number))[1] if best else graded[-1][1]
