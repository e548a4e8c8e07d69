"""The controller of 08 is judged behind the student's processor, and without it if that fails."""

from __future__ import annotations

from typing import Any

import pytest

from autograder.checks.ch08_capstone.hidden.judges import judge_driving
from autograder.suite import CheckFailed


class Kept:
    """Replaces a shared system: a check's body only sees its name."""

    def __init__(self, name: str) -> None:
        self.name, self.closed = name, 0

    def get(self, *needed: str) -> Any:
        return self.name

    def close(self) -> None:
        self.closed += 1


def judge(fractions: dict[str, float]) -> tuple[Any, Any]:
    """Judge a body that fails in the systems that are named, with these fractions."""
    shared, separate = Kept("shared"), Kept("lone")

    def body(system: Any) -> None:
        if system in fractions:
            raise CheckFailed(system, fraction=fractions[system])

    judge_driving(shared, separate, body)  # type: ignore[arg-type]
    return shared, separate


def test_a_check_that_passes_in_one_of_two_gradings_passes() -> None:
    assert judge({})[0].closed == 0
    shared, separate = judge({"shared": 0.0})
    assert (shared.closed, separate.closed) == (1, 0)


@pytest.mark.parametrize(
    ("fractions", "message"),
    [({"shared": 0.0, "lone": 0.0}, "shared"), ({"shared": 0.25, "lone": 0.5}, "lone")],
)
def test_a_check_that_fails_in_both_gradings_has_the_better_outcome(fractions: dict[str, float], message: str) -> None:
    with pytest.raises(CheckFailed) as failed:
        judge(fractions)
    assert failed.value.message == message
