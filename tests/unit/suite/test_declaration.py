"""The rules for the declaration of a check."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import pytest

from autograder.exceptions import GraderError
from autograder.suite import CheckFailed, CheckRow, Visibility, check, check_each_row, check_of, expect, group, hint


@pytest.mark.promise("Its docstring is the sentence that the student reads.")
def test_a_declared_check_takes_its_id_and_title_from_the_function() -> None:
    @check(points=2, group="reaction", doc="https://docs.ros.org", needs=("starts",))
    @hint("one")
    @hint("two")
    def test_turns() -> None:
        """The robot turns when
        it must.

        More for maintainers.
        """  # noqa: D205

    declared = check_of(test_turns)
    assert declared is not None
    assert (declared.id, declared.title, declared.points) == ("turns", "The robot turns when it must.", 2.0)
    assert (declared.group, declared.hints, declared.doc) == ("reaction", ("one", "two"), "https://docs.ros.org")
    assert (declared.needs, declared.visibility) == (("starts",), Visibility.HIDDEN)


def test_a_function_without_a_declaration_is_not_a_check() -> None:
    assert check_of(lambda: None) is None


def test_checks_of_a_group_inherit_its_page_and_dependencies_unless_they_declare_their_own() -> None:
    check = group("reaction", doc="https://docs.ros.org", needs=("starts",), after=("sees",))

    @check(points=1)
    def test_turns() -> None:
        """The robot turns."""

    @check(points=1, doc=None, needs=(), after=("turns",))
    def test_stops() -> None:
        """The robot stops."""

    turns, stops = check_of(test_turns), check_of(test_stops)
    assert turns is not None
    assert stops is not None
    assert (turns.group, turns.doc, turns.needs) == ("reaction", "https://docs.ros.org", ("starts",))
    assert (turns.after, turns.dependencies, stops.dependencies) == (("sees",), ("starts", "sees"), ("turns",))
    assert (stops.group, stops.doc, stops.needs) == ("reaction", None, ())


def test_hints_above_the_declaration_are_an_error() -> None:
    with pytest.raises(GraderError, match="'test_turns': its hints must be below `check`"):

        @hint("never seen")
        @check(points=1, group="g")
        def test_turns() -> None:
            """The robot turns."""


@pytest.mark.parametrize(("folder", "visibility"), [("visible", Visibility.VISIBLE), ("hidden", Visibility.HIDDEN)])
def test_the_folder_decides_the_visibility_of_a_check_also_in_a_table(
    tmp_path: Path, folder: str, visibility: Visibility
) -> None:
    module = ModuleType("a_suite")
    text = """
from autograder.suite import CheckRow, check, check_each_row, group

@check(points=1, group="g")
def test_one():
    'One.'

@check_each_row(group("h"), [CheckRow(id="two", title="Two.", points=2, hints=("how",), doc="d")])
def body(row, robot):
    pass
"""
    exec(compile(text, tmp_path / folder / "a_suite.py", "exec"), vars(module))
    one, two = check_of(module.test_one), check_of(module.test_two)
    assert one is not None
    assert two is not None
    assert (one.visibility, two.visibility) == (visibility, visibility)
    assert (two.id, two.title, two.points, two.group, two.hints, two.doc) == ("two", "Two.", 2.0, "h", ("how",), "d")


def test_a_check_of_a_table_calls_the_body_with_its_row_and_asks_for_the_body_s_fixtures() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Distance(CheckRow):
        metres: float

    rows = [
        Distance(id=name, title=name, points=1, hints=(), doc="d", metres=len(name)) for name in ("near", "farther")
    ]
    calls = []

    @check_each_row(group("g"), rows)
    def measures(row: Distance, robot: str) -> None:
        calls.append((row.id, row.metres, robot))

    functions = [globals().pop(f"test_{row.id}") for row in rows]
    assert [list(inspect.signature(function).parameters) for function in functions] == [["robot"], ["robot"]]
    for function in functions:
        function(robot="r2")
    assert calls == [("near", 4, "r2"), ("farther", 7, "r2")]


def test_the_body_of_a_table_must_not_look_like_a_test() -> None:
    with pytest.raises(GraderError, match="body 'tests_all': its name must not start with 'test'"):

        @check_each_row(group("g"), ())
        def tests_all(row: CheckRow) -> None:
            """A body."""


def test_a_check_must_be_a_pytest_function() -> None:
    with pytest.raises(GraderError, match="'turns': its name must start with 'test_'"):

        @check(points=1, group="g")
        def turns() -> None:
            """A title."""


def test_a_check_must_have_a_docstring() -> None:
    with pytest.raises(GraderError, match="'test_turns': it needs a docstring"):

        @check(points=1, group="g")
        def test_turns() -> None:
            pass


@pytest.mark.parametrize("points", [0, -1, float("nan"), float("inf")])
def test_a_check_must_be_worth_points(points: float) -> None:
    with pytest.raises(GraderError, match="points must be above 0"):

        @check(points=points, group="g")
        def test_turns() -> None:
            """A title."""


def test_expect_fails_the_check_with_its_message_and_fraction() -> None:
    expect(True, "never said")
    with pytest.raises(CheckFailed, match="it kept driving") as excinfo:
        expect(False, "it kept driving", fraction=0.5)
    assert (excinfo.value.message, excinfo.value.fraction) == ("it kept driving", 0.5)


@pytest.mark.parametrize("fraction", [1.0, -0.1, float("nan"), float("inf")])
def test_a_failed_check_cannot_earn_full_points(fraction: float) -> None:
    with pytest.raises(GraderError, match=r"must be in \[0, 1\)"):
        CheckFailed("why", fraction=fraction)
