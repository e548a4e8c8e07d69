"""Limits how long a submission may keep the grader waiting: one account for all waits of a grading.

A process runs one grading at a time. Outside a grading, as in a notebook, nothing is counted.

Each wait for a program has a bound of its own. But a program that sleeps a little at each step, or that takes a minute
to start for each check, stays within all of them. It could hold a grading until its worker sandbox is stopped, and
there would be no result. So there are two bounds on the sums, and exceeding one is a failure of the student's program.
"""

from __future__ import annotations

import math
import time

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError

# For answers to steps, without the time for which a busy machine kept the programs from running. A reference's
# answers take less than 40 s, on a machine with eight times as much to do as it can.
HELD_SECONDS = 180.0
RESERVE = 1 / 15  # of the lifetime of a worker sandbox, for the work of the grader after the time is over


class _Account:
    deadline = math.inf
    total = 0.0
    held = 0.0


def begin(seconds: float) -> None:
    """Open the account of a grading that may take `seconds` of real time from now, the reserve included."""
    _Account.total = seconds * (1 - RESERVE)
    _Account.deadline = time.monotonic() + _Account.total
    _Account.held = 0.0


def add_held(seconds: float) -> None:
    """Add the time that a program took for its answers."""
    _Account.held += seconds


def is_held(seconds: float = 0.0) -> bool:
    """Return whether programs, the last one for `seconds`, made the grading wait longer than allowed."""
    return math.isfinite(_Account.deadline) and _Account.held + seconds > HELD_SECONDS


def bounded(seconds: float) -> float:
    """Return how long a wait may take that may take `seconds` by itself."""
    return max(0.0, min(seconds, _Account.deadline - time.monotonic()))


def is_over() -> bool:
    """Return whether the grading has no time left for programs."""
    return time.monotonic() > _Account.deadline or is_held()


def is_late() -> bool:
    """Return whether more than half of the grading's time is over: too little is left for another try."""
    return _Account.deadline - time.monotonic() < _Account.total / 2


def require() -> None:
    """Raise a StudentError if the grading has no time left for programs."""
    if is_held():
        raise too_slow()
    if is_over():
        sentence = (
            f"Your programs, tests and launches took {_Account.total / 60:.0f} minutes in all, and the grader waits no "
            "longer: look for a sleep, or for a wait without a deadline."
        )
        raise StudentError(Diagnosis(Kind.TIMED_OUT, sentence))


def too_slow() -> StudentError:
    """Return the error for programs that made the grading wait longer than allowed."""
    sentence = (
        f"Your nodes kept the grader waiting for {HELD_SECONDS:.0f} s in all, and it waits no longer: a callback has "
        "to return at once, without a sleep, a loop that waits or a blocking call."
    )
    return StudentError(Diagnosis(Kind.TIMED_OUT, sentence))
