"""Statistics of a class: its marks, its checks and the most frequent reasons."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from autograder.report.feedback.statistics import class_statistics
from autograder.result.model import Result
from autograder.suite import Outcome

MakeResult = Callable[..., Result]


def with_passes(result: Result, *passes: bool) -> Result:
    """Return a result of checks worth 1 point each, passed or failed."""
    outcomes = [(Outcome.PASSED, 1.0) if is_passed else (Outcome.FAILED, 0.0) for is_passed in passes]
    checks = tuple(
        replace(check, outcome=outcome, points=points, max_points=1.0)
        for check, (outcome, points) in zip(result.checks, outcomes, strict=False)
    )
    return replace(result, checks=checks, max_score=float(len(passes)))


@pytest.mark.promise("The page shows the distribution of marks")
def test_marks_are_counted_in_bands_and_full_marks_are_in_the_last(make_result: MakeResult) -> None:
    results = [with_passes(make_result(), *([True] * n + [False] * (4 - n))) for n in (0, 1, 2, 4)]
    assert class_statistics(results).bands == (1, 0, 1, 0, 0, 1, 0, 0, 0, 1)


@pytest.mark.promise("how well it separates strong answers from weak ones")
def test_a_check_that_only_good_submissions_pass_has_a_high_discrimination(make_result: MakeResult) -> None:
    rows = [(True, True, False), (True, True, False), (False, False, True), (False, False, True)]
    by_id = {c.id: c for c in class_statistics([with_passes(make_result(), *row) for row in rows]).checks}
    assert by_id["starts"].difficulty == 0.5
    assert by_id["turns"].discrimination == pytest.approx(-1.0)
    discrimination = by_id["starts"].discrimination
    assert discrimination is None or discrimination > by_id["turns"].discrimination  # type: ignore[operator]


def test_a_check_with_equal_results_has_no_discrimination_and_one_that_all_passed_is_omitted(
    make_result: MakeResult,
) -> None:
    (missed,) = class_statistics([with_passes(make_result(), True, False) for _ in range(3)]).checks
    assert (missed.id, missed.passed, missed.total, missed.discrimination) == ("listens", 0, 3, None)


@pytest.mark.promise("the most frequent messages")
def test_a_reason_is_counted_once_for_each_student_who_got_it(make_result: MakeResult) -> None:
    reasons = class_statistics([make_result("alice"), make_result("bob")]).reasons
    assert ("it starts after 3 s", 2) in reasons
    assert class_statistics([make_result("alice")]).reasons == ()
