"""The total time that a submission may keep the grader waiting."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.run import patience
from autograder.run.sandbox import Sandbox
from autograder.run.sandbox.launcher import launch


@pytest.fixture(autouse=True)
def account(monkeypatch: pytest.MonkeyPatch) -> None:
    """Restore the account of waiting time after each test."""
    for name in ("deadline", "total", "answer_seconds"):
        monkeypatch.setattr(patience._Budget, name, getattr(patience._Budget, name))


def test_waits_are_limited_to_the_rest_of_the_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    patience.begin(100.0 / (1 - patience.RESERVE))
    assert patience.bounded(30.0) == 30.0
    assert 95.0 < patience.bounded(600.0) <= 100.0
    assert not patience.is_late()
    patience.require()
    later = time.monotonic() + 101.0
    monkeypatch.setattr(time, "monotonic", lambda: later)
    assert patience.is_late()
    assert patience.bounded(30.0) == 0.0
    with pytest.raises(StudentError, match="2 minutes in total") as excinfo:
        patience.require()
    assert excinfo.value.diagnosis.kind is Kind.TIMED_OUT


def test_programs_that_stall_the_grading_use_up_its_budget() -> None:
    patience.begin(900.0)
    patience.add_answer_time(patience.MAX_ANSWER_SECONDS - 1.0)
    patience.require()
    assert not patience.is_too_slow(0.5)
    assert patience.is_too_slow(1.5)
    patience.add_answer_time(1.5)
    with pytest.raises(StudentError, match="kept the grader waiting for 180 s in total"):
        patience.require()


def test_without_a_grading_nothing_is_counted() -> None:
    patience.add_answer_time(1e6)
    assert patience.bounded(30.0) == 30.0
    patience.require()


def test_no_program_is_started_when_the_time_is_over(tmp_path: Path) -> None:
    patience.begin(0.0)
    with pytest.raises(StudentError, match="in total, which is the limit"):
        launch(["true"], Sandbox(tmp_path))
