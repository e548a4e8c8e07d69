"""All workers grade test cases at the same time, and each result has its own folder."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest

from autograder.author.verification.cases import WITHOUT_PICTURES, Case
from autograder.author.verification.verdicts import CaseKind, verify_full_marks
from autograder.author.verification.verify_cases import verify_cases
from autograder.author.verification.worker_pool import WorkerPool
from autograder.diagnosis import Diagnosis, Kind
from autograder.grade.job import Job, Options
from autograder.grade.pipeline import unclear_result
from autograder.result.model import Status
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.process import ExitReason
from autograder.run.sandbox.worker_sandbox import WorkerReport
from autograder.submission.intake import read_submission
from autograder.suite.suites import Suite

WORKERS = 3
CHAPTERS = ("01_package_structure", "02_nodes", "03_interfaces")


class NoGrader:
    """A pool whose gradings all fail, but not before all workers have started one."""

    isolation, count = Isolation.PROCESS, WORKERS

    def __init__(self) -> None:
        self._together = threading.Barrier(WORKERS, timeout=60.0)

    def __call__(self, job: Job) -> WorkerReport:
        self._together.wait()
        return WorkerReport(ExitReason.EXITED, 1, f"no grader for {job.student}")


class OneByOne(NoGrader):
    """One worker."""

    count = 1

    def __init__(self) -> None:
        self._together = threading.Barrier(1)


class Recorder(OneByOne):
    """One worker that records a result without points and counts its calls."""

    count, calls = 1, 0

    def __call__(self, job: Job) -> WorkerReport:
        self.calls += 1
        digest = read_submission(job.path, job.assignment).sha256
        result = unclear_result(job, Diagnosis(Kind.OK, "It was looked at."))
        recorded = replace(result, submission_sha256=digest, status=Status.GRADED).to_json()
        return WorkerReport(ExitReason.EXITED, 0, "", {"result.json": json.dumps(recorded).encode()})


def case(assignment: str, write: Callable[[Path], None] = Path.mkdir) -> Case:
    return Case(assignment, CaseKind.REFERENCE, "reference", write, verify_full_marks)


def run(cases: list[Case], out: Path, **options: Any) -> list[str]:
    verdicts = verify_cases(cases, seed=1, out=out, workers=cast(WorkerPool, NoGrader()), **options)
    return [verdict.mismatch for verdict in verdicts]


def test_submissions_of_several_chapters_may_have_the_same_name(tmp_path: Path) -> None:
    graded: list[str] = []
    mismatches = run(
        [case(name) for name in CHAPTERS], tmp_path, on_verdict=lambda verdict: graded.append(verdict.assignment)
    )
    assert all(mismatches), "an ungraded case is a mismatch"
    assert sorted(graded) == list(CHAPTERS)
    logs = [(tmp_path / name / "reference" / "grader.log").read_text() for name in CHAPTERS]
    assert all("no grader for reference" in log for log in logs)


def test_chapters_are_graded_at_the_same_time_and_reported_in_order(tmp_path: Path) -> None:
    order: list[str] = []

    def named(assignment: str, name: str) -> Case:
        def write(folder: Path) -> None:
            folder.mkdir()
            order.append(f"{assignment[:2]} {name}")

        return replace(case(assignment, write), name=name)

    cases = [*(named("01_package_structure", name) for name in "abcd"), *(named("02_nodes", name) for name in "ab")]
    verdicts = verify_cases(cases, seed=1, out=tmp_path, workers=cast(WorkerPool, OneByOne()))
    assert [(verdict.assignment, verdict.name) for verdict in verdicts] == [
        (case.assignment, case.name) for case in cases
    ]
    assert order == ["01 a", "01 b", "02 a", "01 c", "01 d", "02 b"]


def test_a_submission_that_cannot_be_written_ends_the_verification(tmp_path: Path) -> None:
    def fails(folder: Path) -> None:
        raise FileNotFoundError("no such reference")

    with pytest.raises(FileNotFoundError, match="no such reference"):
        run([case(CHAPTERS[0], fails)], tmp_path)


def test_a_result_is_reused_only_for_the_same_files_submission_and_whole_suite(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    worker = Recorder()

    def gradings(text: str, options: Options = WITHOUT_PICTURES, seed: int = 1) -> int:
        def write(folder: Path) -> None:
            (folder / "src").mkdir(parents=True)
            (folder / "src" / "package.xml").write_text(text)

        before = worker.calls
        verify_cases(
            [replace(case(CHAPTERS[0], write), options=options)],
            seed=seed,
            out=tmp_path,
            workers=cast(WorkerPool, worker),
        )
        return worker.calls - before

    part = replace(WITHOUT_PICTURES, only=("found",))
    assert [gradings("one"), gradings("one")] == [1, 0]
    assert [gradings("one", seed=2), gradings("two"), gradings("two")] == [1, 1, 0]
    assert [gradings("two", part), gradings("two", part), gradings("two")] == [1, 1, 0]
    monkeypatch.setattr(Suite, "files_digest", property(lambda suite: "of another comment"))
    assert [gradings("two"), gradings("two")] == [1, 0]
