"""Drawn cases find a violated rule, and the simplest case that shows it."""

from __future__ import annotations

import importlib
import random
from pathlib import Path

import pytest
from hypothesis import strategies as st

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.suite import CheckFailed
from autograder.suite.drawn_cases import SHRINKS, SHRINKS_PER_CASE, expect_each

NUMBERS = st.integers(0, 10_000)


def drawn(seed: int, count: int = 60) -> list[int]:
    cases: list[int] = []
    expect_each(NUMBERS, cases.append, random.Random(seed), count=count)
    return cases


def test_the_same_seed_draws_the_same_cases() -> None:
    assert drawn(1) == drawn(1)
    assert drawn(1) != drawn(2)


def test_the_cases_do_not_depend_on_the_modules_that_are_loaded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = drawn(8, count=200)
    (tmp_path / "module_of_constants.py").write_text("NUMBERS = (4321, 4322, 4323, 4324, 4325)\n")
    monkeypatch.syspath_prepend(tmp_path)
    importlib.import_module("module_of_constants")
    assert drawn(8, count=200) == before


def test_a_rule_that_holds_is_judged_as_often_as_asked() -> None:
    assert len(drawn(3, count=25)) == 25


def test_the_simplest_failing_case_is_reported_with_its_fraction_and_hints() -> None:
    def judge(case: int) -> None:
        if case > 1000:
            raise CheckFailed(f"wrong for {case}", fraction=0.5, hints=("look at 1001",))

    with pytest.raises(CheckFailed) as caught:
        expect_each(NUMBERS, judge, random.Random(4))
    assert (caught.value.message, caught.value.fraction) == ("wrong for 1001", 0.5)
    assert caught.value.hints == ("look at 1001",)


@pytest.mark.parametrize(("count", "shrinks"), [(60, SHRINKS), (2, 2 * SHRINKS_PER_CASE)])
def test_shrinking_judges_a_bounded_number_of_cases(count: int, shrinks: int) -> None:
    judged: list[int] = []

    def judge(case: int) -> None:
        judged.append(case)
        if case % 2:
            raise CheckFailed(f"wrong for {case}")

    with pytest.raises(CheckFailed):
        expect_each(
            st.lists(NUMBERS, min_size=8).map(lambda numbers: 2 * sum(numbers) + 1),
            judge,
            random.Random(5),
            count=count,
        )
    first = next(place for place, case in enumerate(judged) if case % 2)
    assert len(judged) <= first + 2 + shrinks


def test_a_failure_that_depends_on_the_case_before_is_told_with_it() -> None:
    before: list[int] = []

    def judge(case: int) -> None:
        follows_large = bool(before) and before[-1] > 5000
        before.append(case)
        if follows_large and case < 5000:
            raise CheckFailed(f"wrong for {case}.")

    with pytest.raises(CheckFailed) as caught:
        expect_each(NUMBERS, judge, random.Random(6))
    assert caught.value.message.startswith("wrong for ")
    assert " It did so right after another case, " in caught.value.message


def test_another_exception_ends_the_check_at_once() -> None:
    judged: list[int] = []

    def judge(case: int) -> None:
        judged.append(case)
        raise StudentError(Diagnosis(Kind.MISSING_PACKAGE, "There is no package."))

    with pytest.raises(StudentError, match="There is no package"):
        expect_each(NUMBERS, judge, random.Random(7))
    assert len(judged) == 1
