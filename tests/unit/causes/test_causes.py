"""Dependent failures are listed below their cause, and the most expensive cause comes first."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from autograder.result.causes import causes, costliest_failure
from autograder.result.model import CheckResult
from autograder.suite import Check, Outcome

MakeCheck = Callable[..., Check]
Make = Callable[..., CheckResult]
FAILED, PASSED, NOT_CHECKED = Outcome.FAILED, Outcome.PASSED, Outcome.NOT_CHECKED


@pytest.fixture
def result(make_check: MakeCheck) -> Make:
    """Make the result of a check that comes `after` others."""

    def make(id: str, outcome: Outcome, *after: str, points: float = 1.0, message: str = "") -> CheckResult:
        check = make_check(id, f"It is {id}.", points, "graph", after=after)
        return CheckResult.of(check, outcome, message or f"{id} is wrong")

    return make


def folded(*checks: CheckResult, diagnosis: str = "") -> list[tuple[str, str, str]]:
    """Return each cause with the ids of the checks that failed or were skipped because of it."""
    all_causes = causes(checks, diagnosis)
    assert sorted(check.id for cause in all_causes for check in cause.checks) == sorted(check.id for check in checks)
    return [(c.check.id, " ".join(o.id for o in c.failed), " ".join(o.id for o in c.unchecked)) for c in all_causes]


def test_failures_after_a_failure_are_folded_under_it_directly_or_not(result: Make) -> None:
    assert folded(
        result("a", PASSED),
        result("b", FAILED, "a"),
        result("c", FAILED, "a", "b"),
        result("d", NOT_CHECKED, "c"),
        result("e", FAILED, "d"),
        result("f", PASSED, "b"),
        result("g", FAILED, "f"),
    ) == [("a", "", ""), ("b", "c e", "d"), ("f", "", ""), ("g", "", "")]


def test_a_check_is_folded_under_a_cause_that_is_shown_after_it(result: Make) -> None:
    checks = result("b", FAILED, "a"), result("a", FAILED)
    assert folded(*checks) == [("a", "b", "")]


def test_a_check_that_names_itself_or_an_unknown_check_has_no_cause(result: Make) -> None:
    assert folded(result("a", FAILED, "gone"), result("b", FAILED, "b")) == [("a", "", ""), ("b", "", "")]


def test_checks_that_were_not_run_for_the_same_reason_share_one_line(result: Make) -> None:
    build = [result(name, NOT_CHECKED, message="it does not build") for name in "abc"]
    assert folded(*build, result("d", NOT_CHECKED, "c", message="first c")) == [("a", "", "b c d")]
    assert causes(build)[0].not_checked == "Not checked: It is b. It is c."
    group_cause = causes([result(name, NOT_CHECKED, message="it does not build") for name in "abcde"])[0]
    assert (group_cause.not_checked, len(group_cause.unnamed)) == ("Not checked: 4 more checks.", 4)
    assert folded(result("a", NOT_CHECKED, message="x"), result("b", NOT_CHECKED)) == [("a", "", ""), ("b", "", "")]


def test_checks_that_failed_with_the_message_of_the_diagnosis_have_one_cause(result: Make) -> None:
    checks = [result(name, FAILED, message="It crashed.") for name in "ab"]
    assert folded(*checks, result("c", FAILED), diagnosis="It crashed.") == [("a", "b", ""), ("c", "", "")]
    assert folded(*checks, diagnosis="It hangs.") == [("a", "", ""), ("b", "", "")]


def test_the_most_expensive_cause_includes_its_consequences_and_the_first_of_equals_wins(result: Make) -> None:
    small, large = result("small", FAILED, points=2.0), result("large", FAILED, points=3.0)
    equally_costly, passed = result("equal", FAILED, points=3.0), result("passed", PASSED, points=9.0)
    assert costliest_failure(causes([passed, small, large, equally_costly])) == large
    with_small = [result(name, outcome, "small") for name, outcome in (("x", FAILED), ("y", NOT_CHECKED))]
    assert costliest_failure(causes([small, large, *with_small])) == small
    assert costliest_failure(causes([passed, result("unknown", NOT_CHECKED)])) is None
