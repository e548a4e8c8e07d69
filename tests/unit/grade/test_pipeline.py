"""Workers' replies are validated, points lost on a busy machine are graded again, and tries share a time budget."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from autograder.grade import grade_submission, pipeline
from autograder.grade.job import Job
from autograder.grade.store import LOG, write_result
from autograder.result.model import Artifact, CheckResult, Result, Status
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.process import ExitReason
from autograder.run.sandbox.worker_sandbox import WorkerReport
from autograder.suite import Check, Outcome, suites

CHAPTER = "02_nodes"
MakeResult = Callable[..., Result]
FAILED = WorkerReport(ExitReason.EXITED, 1, "Traceback: of the grader")


class Worker:
    """Replaces the workers: returns one result after another, and records whether it ran alone."""

    def __init__(self, *results: Result | None) -> None:
        self.remaining, self.alone, self.times = list(results), list[bool](), list[float]()
        self.last: list[bool] = []  # whether each try was announced as the last one

    def __call__(self, job: Job) -> WorkerReport:
        self.alone.append(pipeline._machine._turn.locked())
        self.times.append(job.seconds)
        self.last.append(job.is_last_try)
        result = self.remaining.pop(0)
        if result is None:
            return FAILED
        return WorkerReport(ExitReason.EXITED, 0, "", {"result.json": json.dumps(result.to_json()).encode()})


@pytest.fixture
def doubtful_result(make_result: MakeResult) -> Result:
    """A result with a point lost in real time, while the machine was busy."""
    suite = suites.hidden(CHAPTER)
    first_check, *other_checks = suite.checks
    checks = (
        CheckResult.of(first_check, Outcome.FAILED),
        *(CheckResult.of(check, Outcome.PASSED) for check in other_checks),
    )
    versions = {"suite_version": suite.version, "files_digest": suite.files_digest, "max_score": suite.max_score}
    return make_result("s", checks=checks, time="real", held_up=0.6, isolation="process", seed=1, **versions)


def with_all_points(doubtful_result: Result) -> Result:
    """The same result with all points."""
    return dataclasses.replace(doubtful_result, checks=tuple(map(passed, suites.hidden(CHAPTER).checks)))


def passed(check: Check) -> CheckResult:
    return CheckResult.of(check, Outcome.PASSED)


def grade(folder: Path, worker: Worker, seconds: float = 900.0) -> Result:
    """Grade a submission with the worker."""
    return grade_submission(Job(folder, CHAPTER, "s", 1, folder / "out", Isolation.PROCESS, seconds=seconds), worker)


@pytest.mark.promise(
    "If such a program loses a point while the machine was busy, it is graded once more, alone.",
    "a program in real time that lost a point while the machine was busy is graded once more, alone",
)
def test_a_result_in_doubt_is_graded_again_alone_and_replaced(tmp_path: Path, doubtful_result: Result) -> None:
    worker = Worker(doubtful_result, with_all_points(doubtful_result))
    result = grade(tmp_path, worker)
    assert result.checks[0].outcome is Outcome.PASSED
    assert not result.in_doubt
    assert worker.alone == [False, True]


def test_a_result_in_doubt_is_graded_again_only_once_and_stays_in_doubt(
    tmp_path: Path, doubtful_result: Result
) -> None:
    worker = Worker(doubtful_result, dataclasses.replace(doubtful_result, held_up=0.7))
    result = grade(tmp_path, worker)
    assert result.in_doubt
    assert result.held_up == 0.7
    assert worker.alone == [False, True]


@pytest.mark.parametrize("change", [{"held_up": 0.05}, {"time": "lockstep"}], ids=["a quiet machine", "lockstep"])
def test_a_point_that_is_lost_without_doubt_is_not_graded_again(
    tmp_path: Path, doubtful_result: Result, change: dict[str, object]
) -> None:
    worker = Worker(dataclasses.replace(doubtful_result, **change))  # type: ignore[arg-type]
    assert grade(tmp_path, worker).score == doubtful_result.score
    assert worker.alone == [False]


def test_a_grader_that_fails_in_the_second_grading_gives_no_mark_and_keeps_its_log(
    tmp_path: Path, doubtful_result: Result
) -> None:
    result = grade(tmp_path, Worker(doubtful_result, None, None))
    assert result.status is Status.NOT_GRADED
    assert "Traceback: of the grader" in (tmp_path / "out" / "grader.log").read_text()


def test_a_log_contains_no_control_characters_for_a_terminal(tmp_path: Path, doubtful_result: Result) -> None:
    job = Job(tmp_path, doubtful_result.assignment, "alice", 1, tmp_path / "out")
    write_result(job, doubtful_result, {LOG: b"Traceback:\n\tin \x1b]0;title\x07 \xe2\x80\xae \x9b2J \xff\n"})
    log = (tmp_path / "out" / LOG).read_text(encoding="utf-8")
    assert log == "Traceback:\n\tin \\x1b]0;title\\x07 \\u202e \ufffd2J \ufffd\n"


class SlowWorker(Worker):
    """A worker that takes a part of the time that it gets, on a clock that nothing else moves."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, part: float, *results: Result | None) -> None:
        super().__init__(*results)
        self.part, self.now = part, 0.0
        monkeypatch.setattr(pipeline, "time", SimpleNamespace(monotonic=lambda: self.now))

    def __call__(self, job: Job) -> WorkerReport:
        self.now += self.part * job.seconds
        return super().__call__(job)


def test_a_second_try_has_only_the_time_that_the_first_has_left(
    tmp_path: Path, doubtful_result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    worker = SlowWorker(monkeypatch, 0.5, None, with_all_points(doubtful_result))
    assert grade(tmp_path, worker, seconds=400.0).status is Status.GRADED
    assert worker.times == [400.0, 200.0]


def test_a_submission_that_used_up_its_budget_is_not_tried_again_and_gets_no_zero(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    worker = SlowWorker(monkeypatch, 0.9, None)
    result = grade(tmp_path, worker, seconds=400.0)
    assert worker.remaining == []
    assert result.status is Status.NOT_GRADED
    assert "The grader failed on this submission. This is not a zero" in result.diagnosis.sentence


FORGED: dict[str, Callable[[Result], Result]] = {
    "another student": lambda result: dataclasses.replace(result, student="bob"),
    "another assignment": lambda result: dataclasses.replace(result, assignment="03_interfaces"),
    "another seed": lambda result: dataclasses.replace(result, seed=2),
    "another isolation level": lambda result: dataclasses.replace(result, isolation="bubblewrap"),
    "another version": lambda result: dataclasses.replace(result, suite_version="1-000000000000"),
    "a larger maximum": lambda result: dataclasses.replace(result, max_score=result.max_score + 1),
    "fewer checks": lambda result: dataclasses.replace(result, checks=result.checks[1:]),
    "more points than a check is worth": lambda result: dataclasses.replace(
        result,
        checks=(dataclasses.replace(result.checks[0], points=result.checks[0].max_points + 1), *result.checks[1:]),
    ),
    "a picture elsewhere": lambda result: dataclasses.replace(
        result, artifacts=(Artifact("../bob/result.json", "track", "a" * 64, "x"),)
    ),
}


@pytest.mark.parametrize("forgery", FORGED)
def test_a_worker_with_an_invalid_reply_has_failed_and_its_reply_is_discarded(
    tmp_path: Path, doubtful_result: Result, forgery: str
) -> None:
    result = grade(tmp_path, Worker(*2 * [FORGED[forgery](with_all_points(doubtful_result))]))
    assert (result.status, result.student) == (Status.NOT_GRADED, "s")
    assert "a worker" in (tmp_path / "out" / "grader.log").read_text()
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"result.json", "grader.log"}


def test_a_worker_knows_whether_this_is_the_last_attempt(tmp_path: Path, doubtful_result: Result) -> None:
    worker = Worker(None, with_all_points(doubtful_result))
    grade(tmp_path, worker)
    assert worker.last == [False, True]
