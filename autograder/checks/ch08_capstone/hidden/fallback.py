"""Step 2: tests the controller with the student's processor and, if that fails, without it."""

from __future__ import annotations

from collections.abc import Callable

from autograder.checking import CheckFailed, StudentError
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PROCESSOR
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

BodyRunner = Callable[[Callable[[System], None]], None]  # runs the body of a check, which takes the system


def run_with_fallback(shared: SharedSystem, controller_only: SharedSystem, body: Callable[[System], None]) -> None:
    """Run a check's body with the student's processor and, if that fails, with the expected clearances.

    Args:
        shared: the student's system.
        controller_only: the controller alone, to which the expected clearances are sent.
        body: raises if the controller is wrong.

    Raises:
        CheckFailed: the body failed in both; the outcome with the larger fraction is raised.
        StudentError: a program failed in both.
    """
    try:
        body(shared.get(PROCESSOR, CONTROLLER))
    except (CheckFailed, StudentError) as first_error:
        shared.close()  # later checks must not depend on this failure
        try:
            body(controller_only.get(CONTROLLER))
        except (CheckFailed, StudentError) as second_error:
            controller_only.close()
            raise max(first_error, second_error, key=lambda error: getattr(error, "fraction", 0.0)) from None
