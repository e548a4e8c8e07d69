"""The contract of a check."""

from __future__ import annotations

import pytest

from autograder.checks import CheckFailed, Visibility, check, declared, expect
from autograder.exceptions import GraderError


def test_a_declared_check_takes_its_id_and_title_from_the_function() -> None:
    @check(points=2, group="reaction", hints=("one", "two"), doc="https://docs.ros.org", depends=("starts",))
    def test_turns() -> None:
        """The robot turns when
        it must.

        More for maintainers.
        """  # noqa: D205

    found = declared(test_turns)
    assert found is not None
    assert (found.id, found.title, found.points) == ("turns", "The robot turns when it must.", 2.0)
    assert (found.group, found.hints, found.doc) == ("reaction", ("one", "two"), "https://docs.ros.org")
    assert (found.depends, found.visibility) == (("starts",), Visibility.HIDDEN)


def test_a_function_that_declares_nothing_is_no_check() -> None:
    assert declared(lambda: None) is None


def test_a_check_must_be_a_pytest_function() -> None:
    with pytest.raises(GraderError, match="'turns': its name must start with 'test_'"):

        @check(points=1, group="g")
        def turns() -> None:
            """A title."""


def test_a_check_must_say_what_it_checks() -> None:
    with pytest.raises(GraderError, match="'test_turns': it needs a docstring"):

        @check(points=1, group="g")
        def test_turns() -> None:
            pass


@pytest.mark.parametrize("points", [0, -1, float("nan"), float("inf")])
def test_a_check_must_be_worth_something(points: float) -> None:
    with pytest.raises(GraderError, match="points must be above 0"):

        @check(points=points, group="g")
        def test_turns() -> None:
            """A title."""


def test_expect_fails_the_check_with_its_message_and_fraction() -> None:
    expect(True, "never said")
    with pytest.raises(CheckFailed, match="it kept driving") as caught:
        expect(False, "it kept driving", fraction=0.5)
    assert (caught.value.message, caught.value.fraction) == ("it kept driving", 0.5)


@pytest.mark.parametrize("fraction", [1.0, -0.1, float("nan"), float("inf")])
def test_a_failed_check_cannot_earn_full_points(fraction: float) -> None:
    with pytest.raises(GraderError, match=r"must be in \[0, 1\)"):
        CheckFailed("why", fraction=fraction)
