"""Chooses the next answer to grade: students take turns, however many answers each has handed in."""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping

from autograder.lms.serve.hand_in import HandIn


def in_order(
    waiting: Iterable[HandIn], turns: Mapping[str, int], busy: Collection[str] = frozenset()
) -> Iterator[HandIn]:
    """Yield the queued answers in the order in which they are graded if no other answer arrives.

    The next turn goes to the first student without a turn so far, or else to the student whose last turn was longest
    ago. A student's answers are graded in the order of their arrival. So no student overtakes another one twice.

    Args:
        waiting: the answers, in any order.
        turns: the number of each student's last turn, counted from 1. Students without a turn are missing.
        busy: students with an answer that is being graded now. They come after all others.
    """
    answers: dict[str, deque[HandIn]] = {}
    for answer in sorted(waiting, key=lambda hand_in: hand_in.number):
        answers.setdefault(answer.student, deque()).append(answer)
    turn = 1 + max(turns.values(), default=0)  # the turn of the students whose answers are being graded
    last_turns = {**turns, **dict.fromkeys(busy, turn)}
    heap = [
        (last_turns.get(student, 0), student_answers[0].number, student) for student, student_answers in answers.items()
    ]
    heapq.heapify(heap)
    while heap:
        *_, student = heapq.heappop(heap)
        yield (student_answers := answers[student]).popleft()
        turn += 1
        if student_answers:
            heapq.heappush(heap, (turn, student_answers[0].number, student))


def next_turn(waiting: Iterable[HandIn], turns: Mapping[str, int], busy: Collection[str]) -> HandIn | None:
    """Return the answer to grade next, or None. A student has at most one running grading."""
    return next(in_order((hand_in for hand_in in waiting if hand_in.student not in busy), turns), None)


def ahead_of(number: int, waiting: Iterable[HandIn], turns: Mapping[str, int], busy: Collection[str]) -> int:
    """Return how many queued answers are graded before the one with this number."""
    return next(position for position, hand_in in enumerate(in_order(waiting, turns, busy)) if hand_in.number == number)
