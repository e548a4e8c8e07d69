"""The examination makes the runs of a student's tests that the checks need."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest

from autograder import layout
from autograder.checks.ch06_testing.hidden.examination import FILES, Examination
from autograder.checks.ch06_testing.hidden.faults import faults
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LIMITS
from autograder.harness import Workspace
from autograder.probes import student_test_runs
from autograder.probes.student_test_reports import ClaimedOutcome, Claims, Report, Source, TestRun
from autograder.ros import environment

ALL_PASS = Report(None, 0, Claims({f"test::{number}": ClaimedOutcome.PASSED for number in range(8)}), 0, "")


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    shutil.copytree(layout.SOLUTIONS / "speed_guard", tmp_path / "ws/src/speed_guard")
    (tmp_path / "home").mkdir()
    return Workspace(tmp_path / "ws", environment.find(), tmp_path / "home")


@pytest.fixture
def ordered(monkeypatch: pytest.MonkeyPatch) -> list[TestRun]:
    """What was ordered; every run is said to pass."""
    wanted: list[TestRun] = []

    def note(workspace: Workspace, source: Source, more: Sequence[TestRun]) -> list[Report]:
        wanted.extend(more)
        return [ALL_PASS] * len(more)

    monkeypatch.setattr(student_test_runs, "run", note)
    return wanted


def test_only_the_runs_that_one_check_and_its_dependencies_need_are_made(
    workspace: Workspace, ordered: list[TestRun]
) -> None:
    examination = Examination(workspace, 1, frozenset(("limits_pass", "limits_right", "slow")))
    assert set(examination.runs) == {(LIMITS, what) for what in ("second", "reworded", "backwards", "step", "smooth")}
    assert {order.files for order in ordered} == {(LIMITS,)}
    assert len(ordered) == 6


def test_all_checks_together_run_every_faulty_version(workspace: Workspace, ordered: list[TestRun]) -> None:
    examination = Examination(workspace, 1, frozenset(FILES))
    assert {what for _, what in examination.runs} == {fault.id for fault in faults()} | {
        "second",
        "reworded",
        "backwards",
    }
    assert [order.files[0] for order in ordered[:3]] == [LIMITS, GUARD, LAUNCH]
    assert [order.files[0] for order in ordered if order.sniffed] == [GUARD]


def test_a_run_does_not_depend_on_which_other_runs_are_made(workspace: Workspace, ordered: list[TestRun]) -> None:
    def versions(*checks: str) -> list[TestRun]:
        ordered.clear()
        assert Examination(workspace, 1, frozenset(checks)).runs
        return list(ordered)

    few = versions("limits_pass", "limits_right", "stop")
    many = versions("limits_pass", "limits_right", "stop", "slow", "refused")
    assert all(order in many for order in few)


def test_right_and_faulty_versions_are_mixed_anew_for_each_seed(workspace: Workspace, ordered: list[TestRun]) -> None:
    mixed = {tuple(Examination(workspace, seed, frozenset(FILES)).runs) for seed in range(5)}
    assert len(mixed) == 5
    assert len(ordered) > 5 * len(faults())
