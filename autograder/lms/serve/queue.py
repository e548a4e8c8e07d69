"""Whose answer is graded next: round robin among students, whenever they came and however much they handed in."""

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
    """Give the answers in the order in which they are graded if no other comes.

    The next turn is of the student whose last one is longest ago; of those who never had one, of who came first. Among
    a student's own answers, the oldest is first. So nobody who waits is overtaken twice by the same student.

    Args:
        waiting: the answers, in any order.
        turns: when each student had the last turn, as a count of turns from 1. Who is not in it never had one.
        busy: students with an answer that is being graded now. They come after all others.
    """
    answers: dict[str, deque[Waiting]] = {}
    for answer in sorted(waiting, key=lambda each: each.number):
        answers.setdefault(answer.student, deque()).append(answer)
    turn = 1 + max(turns.values(), default=0)  # of those who are busy
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
    """Return the answer to grade next, None if there is none. A student has one graded at a time."""
    return next(in_order((each for each in waiting if each.student not in busy), turns), None)


def ahead_of(number: int, waiting: Iterable[Waiting], turns: Mapping[str, int], busy: Collection[str]) -> int:
    """Return how many of the answers that wait are graded before the one of this number."""
    return next(place for place, each in enumerate(in_order(waiting, turns, busy)) if each.number == number)
