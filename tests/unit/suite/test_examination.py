"""The examination makes the runs of a student's tests that the checks need."""

from __future__ import annotations

import random
import shutil
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.checks.ch06_testing.hidden.examination import FILES, Examination
from autograder.checks.ch06_testing.hidden.faults import faults
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LIMITS
from autograder.harness import Workspace
from autograder.probes import student_test_runs
from autograder.probes.student_test_reports import ClaimedOutcome, Claims, Report, Source, TestRun
from autograder.ros import environment
from autograder.suite import CheckFailed

ALL_PASS = Report(None, 0, Claims({f"test::{number}": ClaimedOutcome.PASSED for number in range(8)}), 0, "")

NONE_PASS = Report(None, 1, Claims({f"test::{number}": ClaimedOutcome.FAILED for number in range(8)}), 0, "")


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    shutil.copytree(course_paths.SOLUTIONS / "speed_guard", tmp_path / "ws/src/speed_guard")
    (tmp_path / "home").mkdir()
    return Workspace(tmp_path / "ws", environment.find(), tmp_path / "home")


@pytest.fixture
def ordered_runs(monkeypatch: pytest.MonkeyPatch) -> list[TestRun]:
    """The ordered runs; each is reported to pass."""
    orders: list[TestRun] = []

    def run(workspace: Workspace, source: Source, more: Sequence[TestRun]) -> list[Report]:
        orders.extend(more)
        return [ALL_PASS] * len(more)

    monkeypatch.setattr(student_test_runs, "run", run)
    return orders


@pytest.mark.parametrize("checks", [("slow",), ("limits_pass", "limits_right", "slow")], ids=len)
def test_only_the_runs_that_a_check_needs_are_executed(
    workspace: Workspace, ordered_runs: list[TestRun], checks: tuple[str, ...]
) -> None:
    examination = Examination(workspace, 1, frozenset(checks))
    assert set(examination.runs) == {
        (LIMITS, purpose) for purpose in ("second", "reworded", "bare", "backwards", "step", "smooth")
    }
    assert {order.files for order in ordered_runs} == {(LIMITS,)}
    assert len(ordered_runs) == 7


def test_all_checks_together_run_every_faulty_version(workspace: Workspace, ordered_runs: list[TestRun]) -> None:
    examination = Examination(workspace, 1, frozenset(FILES))
    assert {purpose for _, purpose in examination.runs} == {fault.id for fault in faults()} | {
        "second",
        "reworded",
        "bare",
        "backwards",
    }
    assert [order.files[0] for order in ordered_runs[:3]] == [LIMITS, GUARD, LAUNCH]
    assert [order.files[0] for order in ordered_runs if order.sniffed] == [GUARD]


def test_one_check_that_looks_at_all_files_runs_all_of_them(workspace: Workspace, ordered_runs: list[TestRun]) -> None:
    for check in ("as_given", "colcon", "linters", "ends"):
        assert set(Examination(workspace, 1, frozenset((check,))).trial) == {LIMITS, GUARD, LAUNCH}


def test_a_run_does_not_depend_on_which_other_runs_are_made(workspace: Workspace, ordered_runs: list[TestRun]) -> None:
    def versions(*checks: str) -> list[TestRun]:
        ordered_runs.clear()
        assert Examination(workspace, 1, frozenset(checks)).runs
        return list(ordered_runs)

    few_runs = versions("limits_pass", "limits_right", "stop")
    many_runs = versions("limits_pass", "limits_right", "stop", "slow", "refused")
    assert all(order in many_runs for order in few_runs)


def test_correct_and_faulty_versions_are_shuffled_for_each_seed(
    workspace: Workspace, ordered_runs: list[TestRun]
) -> None:
    orders = {tuple(Examination(workspace, seed, frozenset(FILES)).runs) for seed in range(5)}
    assert len(orders) == 5
    assert len(ordered_runs) > 5 * len(faults())


Verdict = Callable[[TestRun, str], bool]  # whether a test, by its name, fails in a run


def examine(monkeypatch: pytest.MonkeyPatch, workspace: Workspace, fails: Verdict) -> tuple[Examination, list[TestRun]]:
    """Return an examination of a test with parameters a to f, and the list of its runs."""
    orders: list[TestRun] = []

    def run(workspace: Workspace, source: Source, more: Sequence[TestRun]) -> list[Report]:
        orders.extend(more)
        return [_report(order, fails) for order in more]

    monkeypatch.setattr(student_test_runs, "run", run)
    return Examination(workspace, 1, frozenset(("limits_pass", "limits_right", "slow"))), orders


def _report(order: TestRun, fails: Verdict) -> Report:
    outcomes: dict[str, ClaimedOutcome] = {}
    for name in (f"test_limits::test[{letter}]" for letter in "abcdef"):
        if name in order.deselected or (order.exit_first and ClaimedOutcome.FAILED in outcomes.values()):
            continue
        outcomes[name] = ClaimedOutcome.FAILED if fails(order, name[-2]) else ClaimedOutcome.PASSED
    report = Report(None, int(ClaimedOutcome.FAILED in outcomes.values()), Claims(outcomes), 0, "")
    return report if order.is_public else report.closed(frozenset({"test_limits::test"}))


def _kind(examination: Examination, order: TestRun) -> str:
    """Return the purpose of a run of the examination."""
    for salt in ((), ("again",)):
        for purpose, run in examination._plan(LIMITS, (), *salt).items():
            if order.version == run.version:
                return purpose
    return "trial"


def test_a_test_that_fails_on_the_given_package_costs_no_line_that_the_others_see(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    examination, orders = examine(
        monkeypatch,
        workspace,
        lambda order, test: test == "b" or (test == "c" and _kind(examination, order) in {"step", "smooth"}),
    )
    examination.expect_passed_on_correct_versions(LIMITS, "backwards")
    examination.expect_detection("slow", "it is a line.")
    assert {order.deselected for order in orders[1:]} == {("test_limits::test[b]",)}


def test_a_test_that_objects_to_a_right_version_is_left_out_and_costs_one_check(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(order: TestRun, test: str) -> bool:
        kind = _kind(examination, order)
        return (test == "b" and kind != "trial") or (test == "c" and kind in {"step", "smooth"})

    examination, orders = examine(monkeypatch, workspace, fails)
    with pytest.raises(
        CheckFailed, match=r"test in test_limits\.py fails on a correct speed_guard that is written differently"
    ):
        examination.expect_passed_on_correct_versions(LIMITS, "backwards")
    examination.expect_detection("slow", "it is a line.")
    assert orders[-1].deselected == ("test_limits::test[b]",)


def test_tests_that_object_to_every_other_version_earn_no_line(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    examination, _ = examine(monkeypatch, workspace, lambda order, test: _kind(examination, order) != "trial")
    with pytest.raises(CheckFailed, match="failures on faulty ones prove nothing"):
        examination.expect_detection("slow", "it is a line.")


def test_tests_that_object_to_right_versions_by_chance_earn_no_line(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    luck = random.Random(1)
    examination, _ = examine(
        monkeypatch, workspace, lambda order, test: _kind(examination, order) != "trial" and luck.random() < 0.5
    )
    with pytest.raises(CheckFailed, match="failures on faulty ones prove nothing"):
        examination.expect_detection("slow", "it is a line.")


@pytest.mark.parametrize(("name", "failures", "counts"), [(GUARD, 1, False), (GUARD, 2, True), (LIMITS, 1, True)])
def test_a_failure_on_a_right_version_counts_the_second_time_if_the_tests_have_deadlines(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch, name: str, failures: int, counts: bool
) -> None:
    made: Counter[str] = Counter()

    def run(workspace: Workspace, source: Source, more: Sequence[TestRun]) -> list[Report]:
        made.update(repr(order.version) for order in more)
        is_late = [not order.is_public and made[repr(order.version)] <= failures for order in more]
        return [(NONE_PASS if late else ALL_PASS).closed(frozenset()) for late in is_late]

    monkeypatch.setattr(student_test_runs, "run", run)
    examination = Examination(workspace, 1, frozenset((f"{name[5:-3]}_right",)))
    with pytest.raises(CheckFailed, match="written differently") if counts else nullcontext():
        examination.expect_passed_on_correct_versions(name)


@pytest.mark.parametrize(("name", "passes"), [(GUARD, True), (LAUNCH, True), (LIMITS, False)])
def test_a_failure_on_the_given_package_counts_the_second_time_if_the_tests_have_deadlines(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch, name: str, passes: bool
) -> None:
    made: Counter[tuple[str, ...]] = Counter()

    def run(workspace: Workspace, source: Source, more: Sequence[TestRun]) -> list[Report]:
        made.update(order.files for order in more)
        return [NONE_PASS if made[order.files] == 1 else ALL_PASS for order in more]

    monkeypatch.setattr(student_test_runs, "run", run)
    assert Examination(workspace, 1, frozenset((f"{name[5:-3]}_pass",))).trial[name].passed is passes
