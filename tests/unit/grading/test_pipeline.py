"""A submission that lost a point in real time on a busy machine is graded once more, alone."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest

from autograder.checks import Outcome
from autograder.grading import grade_submission, pipeline
from autograder.grading.job import Job
from autograder.result import CheckResult, Result, Status, write_json
from autograder.sandbox import Tier
from autograder.sandbox.cell import CellReport
from autograder.sandbox.process import Ending
from tests.conftest import TURNS

CHAPTER = "02_nodes"
MakeResult = Callable[..., Result]
DONE, FAILED = CellReport(Ending.EXITED, 0, ""), CellReport(Ending.EXITED, 1, "Traceback: of the grader")


class Worker:
    """Stands for the workers: comes to one result after the other, and notes whether it was alone."""

    def __init__(self, *results: Result | None) -> None:
        self.left, self.alone = list(results), list[bool]()

    def __call__(self, job_in: Callable[[Path], Job], tier: Tier) -> CellReport:
        self.alone.append(pipeline._machine._turn.locked())
        result = self.left.pop(0)
        if result is None:
            return FAILED
        write_json(job_in(Path("scratch")).out / "result.json", result.to_json())
        return DONE


@pytest.fixture
def lost(make_result: MakeResult) -> Result:
    """A result with a point lost in real time, while the machine was busy."""
    return make_result(checks=(CheckResult.of(TURNS, Outcome.FAILED),), time="real", held_up=0.6)


def grade(folder: Path, worker: Worker) -> Result:
    """Grade something by a worker."""
    return grade_submission(
        folder, CHAPTER, student="s", seed=1, out=folder / "out", isolation=Tier.PROCESS, run_job=worker
    )


def test_a_result_in_doubt_is_graded_again_alone_and_replaced(tmp_path: Path, lost: Result) -> None:
    worker = Worker(lost, dataclasses.replace(lost, checks=(CheckResult.of(TURNS, Outcome.PASSED),)))
    result = grade(tmp_path, worker)
    assert result.checks[0].outcome is Outcome.PASSED
    assert not result.in_doubt
    assert worker.alone == [False, True]


def test_a_result_in_doubt_is_graded_again_only_once_and_stays_in_doubt(tmp_path: Path, lost: Result) -> None:
    worker = Worker(lost, dataclasses.replace(lost, held_up=0.7))
    result = grade(tmp_path, worker)
    assert result.in_doubt
    assert result.held_up == 0.7
    assert worker.alone == [False, True]


@pytest.mark.parametrize("change", [{"held_up": 0.05}, {"time": "lockstep"}], ids=["a quiet machine", "lockstep"])
def test_a_point_that_is_lost_without_doubt_is_not_graded_again(
    tmp_path: Path, lost: Result, change: dict[str, object]
) -> None:
    worker = Worker(dataclasses.replace(lost, **change))  # type: ignore[arg-type]
    assert grade(tmp_path, worker).score == lost.score
    assert worker.alone == [False]


def test_a_grader_that_fails_in_the_second_grading_gives_no_mark_and_keeps_its_log(
    tmp_path: Path, lost: Result
) -> None:
    result = grade(tmp_path, Worker(lost, None, None))
    assert result.status is Status.NOT_GRADED
    assert "Traceback: of the grader" in (tmp_path / "out" / "grader.log").read_text()
