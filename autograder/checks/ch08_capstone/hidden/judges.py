"""Step 2: judges a node behind the student's other nodes, and by what these should say where they are wrong."""

from __future__ import annotations

from collections.abc import Callable

from autograder.checking import CheckFailed, StudentError
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PROCESSOR
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

JudgeDriving = Callable[[Callable[[System], None]], None]  # takes a check's body, which takes the system


def judge_driving(shared: SharedSystem, lone: SharedSystem, body: Callable[[System], None]) -> None:
    """Judge the controller behind the student's processor and, if that fails, by right clearances.

    Args:
        shared: the student's system.
        lone: the controller alone, to which right clearances are sent.
        body: raises where the controller is wrong.

    Raises:
        CheckFailed: it is wrong in both, and this is the better outcome.
        StudentError: its program fails in both.
    """
    try:
        body(shared.get(PROCESSOR, CONTROLLER))
    except (CheckFailed, StudentError) as failed:
        shared.close()  # what it does next must not depend on this
        try:
            body(lone.get(CONTROLLER))
        except (CheckFailed, StudentError) as again:
            lone.close()
            raise max(failed, again, key=lambda error: getattr(error, "fraction", 0.0)) from None
