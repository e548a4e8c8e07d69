"""The controller of 08 is graded with the student's processor, and without it if that fails."""

from __future__ import annotations

from typing import Any

import pytest

from autograder.checks.ch08_capstone.hidden.fallback import run_with_fallback
from autograder.suite import CheckFailed


class SystemStub:
    """Replaces a shared system: a check's body only sees its name."""

    def __init__(self, name: str) -> None:
        self.name, self.closed = name, 0

    def get(self, *needed: str) -> Any:
        return self.name

    def close(self) -> None:
        self.closed += 1


def grade_body(fractions: dict[str, float]) -> tuple[Any, Any]:
    """Grade a check whose body fails in the named systems, with these fractions; return both systems."""
    shared, separate = SystemStub("shared"), SystemStub("lone")

    def body(system: Any) -> None:
        if system in fractions:
            raise CheckFailed(system, fraction=fractions[system])

    run_with_fallback(shared, separate, body)  # type: ignore[arg-type]
    return shared, separate


def test_a_check_that_passes_in_one_of_two_gradings_passes() -> None:
    assert grade_body({})[0].closed == 0
    shared, separate = grade_body({"shared": 0.0})
    assert (shared.closed, separate.closed) == (1, 0)


@pytest.mark.parametrize(
    ("fractions", "message"),
    [({"shared": 0.0, "lone": 0.0}, "shared"), ({"shared": 0.25, "lone": 0.5}, "lone")],
)
def test_a_check_that_fails_in_both_gradings_has_the_better_outcome(fractions: dict[str, float], message: str) -> None:
    with pytest.raises(CheckFailed) as excinfo:
        grade_body(fractions)
    assert excinfo.value.message == message
