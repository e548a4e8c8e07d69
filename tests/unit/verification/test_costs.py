"""A named mutant that costs much more than its own check has a reason, or the report says that it has none."""

from __future__ import annotations

from dataclasses import replace

import pytest

from autograder.author.verification import costs
from autograder.author.verification.costs import Cost
from autograder.author.verification.mutants import Mutant
from autograder.author.verification.verdicts import CaseKind, Verdict
from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.result.model import CheckResult
from autograder.suite import Check, Outcome
from autograder.suite.declaration import Visibility
from tests.conftest import MakeResult

CHECKS = {
    name: Check(name, name, points, "g", Visibility.HIDDEN, (), None, needs, covers, after)
    for name, points, covers, needs, after in (
        ("turns", 2.0, ("near", "left"), (), ()),
        ("sector", 3.0, ("near",), (), ()),
        ("lidars", 4.0, ("bearings",), (), ("sector", "turns")),
        ("edges", 1.0, ("edge",), (), ("lidars",)),
        ("drives", 4.0, ("world",), ("turns",), ()),
        ("ends", 5.0, ("ends",), (), ()),
    )
}


def cost_of(
    make_result: MakeResult,
    monkeypatch: pytest.MonkeyPatch,
    *failed: str,
    unchecked: tuple[str, ...] = (),
    fraction: float = 0.0,
    reason: str = "",
    diagnosis: Diagnosis = OK,
    message: str = "",
) -> Cost:
    """Return the cost of a mutant that was written for `turns`."""
    mutant = Mutant("m", "t", (), "turns", reason=reason)
    monkeypatch.setattr(costs, "mutants", lambda assignment: (mutant,))
    outcomes = dict.fromkeys(failed, Outcome.FAILED) | dict.fromkeys(unchecked, Outcome.NOT_CHECKED)
    checks = tuple(
        CheckResult.of(check, outcomes.get(name, Outcome.PASSED), message or f"{name} is wrong", fraction=fraction)
        for name, check in CHECKS.items()
    )
    result = make_result(checks=checks, diagnosis=diagnosis, max_score=19.0)
    (cost,) = costs.costs([Verdict("02_nodes", CaseKind.MUTANT, "m", result, "")])
    return cost


def test_a_cheap_mutant_needs_no_reason(make_result: MakeResult, monkeypatch: pytest.MonkeyPatch) -> None:
    cost = cost_of(make_result, monkeypatch, "turns", "edges")
    assert (cost.points, cost.lost, cost.requirements) == (2.0, 3.0, ("near", "left", "edge"))
    assert not cost.is_expensive
    assert costs.unexplained([cost]) == []


@pytest.mark.parametrize(
    ("failed", "unchecked", "reason"),
    [
        (("turns", "sector"), (), "3 of the same requirement"),
        (("turns", "lidars", "edges"), (), "5 after it"),
        (("turns",), ("drives",), "4 not checked"),
        (("turns", "sector"), ("drives",), "3 of the same requirement; 4 not checked"),
        (("turns", "ends"), (), ""),
        (("turns", "sector", "ends"), (), ""),
    ],
    ids=["a requirement with two checks", "after", "not checked", "both", "nothing", "not all of it"],
)
def test_the_reason_follows_from_the_result(
    make_result: MakeResult,
    monkeypatch: pytest.MonkeyPatch,
    failed: tuple[str, ...],
    unchecked: tuple[str, ...],
    reason: str,
) -> None:
    cost = cost_of(make_result, monkeypatch, *failed, unchecked=unchecked)
    assert cost.is_expensive
    assert cost.reason == reason
    assert len(costs.unexplained([cost])) == (not reason)


def test_checks_with_the_same_message_have_one_reason(make_result: MakeResult, monkeypatch: pytest.MonkeyPatch) -> None:
    cost = cost_of(make_result, monkeypatch, "turns", "ends", "lidars", "edges", message="There is no topic.")
    assert cost.reason == "5 after it; 5 for the same reason"


def test_partial_credit_reduces_the_cost(make_result: MakeResult, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not cost_of(make_result, monkeypatch, "turns", "ends", fraction=0.5).is_expensive


def test_a_program_that_does_not_run_and_a_written_reason_are_reasons(
    make_result: MakeResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    dead = Diagnosis(Kind.CRASHED_AT_IMPORT, "It ends.")
    assert cost_of(make_result, monkeypatch, "turns", "ends", diagnosis=dead).reason == "crashed at import"
    assert cost_of(make_result, monkeypatch, "turns", "ends", reason="it is off").reason == "it is off"


def test_the_table_and_the_counts_show_mutants_without_a_reason(
    make_result: MakeResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = [cost_of(make_result, monkeypatch, "turns", "ends"), cost_of(make_result, monkeypatch, "turns")]
    assert costs.counts(rows) == {"mutants_expensive": 1, "mutants_expensive_unexplained": 1}
    assert "| 02 | m | turns | 2 | 7 | near, left, ends | **no reason** |" in costs.report(rows)
    assert "| 02 | m | turns | 2 | 2 | near, left |  |" in costs.report(rows)
    assert costs.unexplained(rows) == [
        "02_nodes mutant m: it loses 7 points, turns is worth 2, and no reason is given: write a `reason` in "
        "mutants.yaml, or declare a check `after` turns",
    ]
    assert costs.report([]) == ""


def test_only_named_mutants_that_were_graded_are_counted(make_result: MakeResult) -> None:
    verdict = Verdict("02_nodes", CaseKind.VARIANT, "v", make_result(), "")
    assert costs.costs([verdict, replace(verdict, kind=CaseKind.ATTACK)]) == ()
