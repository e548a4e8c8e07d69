"""Limits how long a submission may keep the grader waiting: one budget for all waits of a grading.

A process runs one grading at a time. Outside a grading, as in a notebook, nothing is counted.

Each wait for a program has its own limit. But a program that sleeps a little at each step, or that takes a minute to
start for each check, exceeds none of these limits. It could delay a grading until the worker sandbox is stopped, and
then there is no result. So two limits apply to the sums of all waits. Exceeding one is a failure of the student's
program.
"""

from __future__ import annotations

import math
import time

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError

# For the answers to all steps, except the time for which a busy machine kept the programs from running. The answers of
# a reference take less than 40 s, even on a machine with eight times the load that it can handle.
MAX_ANSWER_SECONDS = 180.0
RESERVE = 1 / 15  # share of a worker sandbox's lifetime that the grader still has when the programs' time is over


class _Budget:
    deadline = math.inf
    total = 0.0
    answer_seconds = 0.0


def begin(seconds: float) -> None:
    """Start the budget of a grading that may take `seconds` of real time from now, including the reserve."""
    _Budget.total = seconds * (1 - RESERVE)
    _Budget.deadline = time.monotonic() + _Budget.total
    _Budget.answer_seconds = 0.0


def add_answer_time(seconds: float) -> None:
    """Add the time that a program took for its answers."""
    _Budget.answer_seconds += seconds


def is_too_slow(seconds: float = 0.0) -> bool:
    """Return whether all answers of programs, and one more after `seconds`, have taken longer than allowed."""
    return math.isfinite(_Budget.deadline) and _Budget.answer_seconds + seconds > MAX_ANSWER_SECONDS


def bounded(seconds: float) -> float:
    """Return `seconds`, or the remaining time of the grading if that is shorter."""
    return max(0.0, min(seconds, _Budget.deadline - time.monotonic()))


def is_over() -> bool:
    """Return whether the grading has no time left for programs."""
    return time.monotonic() > _Budget.deadline or is_too_slow()


def is_late() -> bool:
    """Return whether more than half of the grading's time is over, so that there is no time for another attempt."""
    return _Budget.deadline - time.monotonic() < _Budget.total / 2


def require() -> None:
    """Raise a StudentError if the grading has no time left for programs."""
    if is_too_slow():
        raise too_slow_error()
    if is_over():
        sentence = (
            f"Your programs, tests and launches took {_Budget.total / 60:.0f} minutes in total, which is "
            "the limit: look for a sleep, or for a wait without a deadline."
        )
        raise StudentError(Diagnosis(Kind.TIMED_OUT, sentence))


def too_slow_error() -> StudentError:
    """Return the error for programs that made the grading wait longer than allowed."""
    sentence = (
        f"Your nodes kept the grader waiting for {MAX_ANSWER_SECONDS:.0f} s in total, which is the limit: a callback "
        "must return at once, without a sleep, a waiting loop or a blocking call."
    )
    return StudentError(Diagnosis(Kind.TIMED_OUT, sentence))
