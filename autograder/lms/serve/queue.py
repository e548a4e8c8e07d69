"""Chooses the next answer to grade: round robin among students, independent of the number of their hand-ins."""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Waiting:
    """An answer that waits: its number, which counts arrivals from 1, and its student."""

    number: int
    student: str


def in_order(
    waiting: Iterable[Waiting], turns: Mapping[str, int], busy: Collection[str] = frozenset()
) -> Iterator[Waiting]:
    """Yield the answers in the order in which they are graded if no other one arrives.

    The next turn goes to the student who never had one and came first, or else to the one whose last turn was longest
    ago. Among a student's own answers, the oldest comes first. So no student overtakes a waiting one a second time.

    Args:
        waiting: the answers, in any order.
        turns: the number of each student's last turn, counted from 1. Students without a turn are missing.
        busy: students with an answer that is being graded now. They come after all others.
    """
    answers: dict[str, deque[Waiting]] = {}
    for answer in sorted(waiting, key=lambda each: each.number):
        answers.setdefault(answer.student, deque()).append(answer)
    turn = 1 + max(turns.values(), default=0)  # students with a running grading
    last = {**turns, **dict.fromkeys(busy, turn)}
    heap = [(last.get(student, 0), own[0].number, student) for student, own in answers.items()]
    heapq.heapify(heap)
    while heap:
        *_, student = heapq.heappop(heap)
        yield (own := answers[student]).popleft()
        turn += 1
        if own:
            heapq.heappush(heap, (turn, own[0].number, student))


def next_turn(waiting: Iterable[Waiting], turns: Mapping[str, int], busy: Collection[str]) -> Waiting | None:
    """Return the answer to grade next, or None. A student has at most one running grading."""
    return next(in_order((each for each in waiting if each.student not in busy), turns), None)


def ahead_of(number: int, waiting: Iterable[Waiting], turns: Mapping[str, int], busy: Collection[str]) -> int:
    """Return how many of the answers that wait are graded before the one of this number."""
    return next(place for place, each in enumerate(in_order(waiting, turns, busy)) if each.number == number)
