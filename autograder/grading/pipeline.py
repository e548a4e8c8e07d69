"""Grading one submission: a worker in a cell, and one retry when the grader itself failed.

A program that cannot be stepped may lose a point that it deserves on a busy machine. Where the machine was seen to hold
it up and it lost a point, the submission is graded once more while this process grades nothing else.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path

from autograder.checks import suites
from autograder.checks.suites import Suite
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.grading.job import ALL, Job, Scope
from autograder.grading.machine_lock import MachineLock
from autograder.grading.store import LOG, RESULT, empty, new_result
from autograder.result import Build, CheckResult, Result, Status, from_json, write_json
from autograder.sandbox import Tier, require
from autograder.sandbox.cell import CellReport, run_in_cell
from autograder.sandbox.process import Ending

TRIES = 2
FAILED = f"The grader failed on this submission, {TRIES} times."
DEFAULT_SEED = 2026  # of every grading that names none, so that the ways to grade draw the same inputs

RunJob = Callable[[Callable[[Path], Job], Tier], CellReport]


_machine = MachineLock()


def in_own_cell(job_in: Callable[[Path], Job], tier: Tier) -> CellReport:
    """Run a job, which `job_in` makes from a scratch folder, by a worker of its own in a cell of its own."""
    return run_in_cell(lambda scratch: _worker(job_in(scratch)), tier)


def grade_submission(
    path: Path,
    assignment: str,
    *,
    student: str,
    seed: int,
    out: Path,
    isolation: Tier = Tier.BUBBLEWRAP,
    scope: Scope = ALL,
    run_job: RunJob = in_own_cell,
) -> Result:
    """Grade one submission.

    Args:
        path: an assignment's folder, a zip of one, a notebook, or a source tree.
        assignment: which assignment it answers.
        student: whose it is; stands in the result only.
        seed: every hidden input is drawn from it; the same seed gives the same inputs.
        out: the folder that gets `result.json` and the pictures, and `grader.log` when the grader failed. An old result
            in it stays until the new one is complete.
        isolation: the sandbox's tier.
        scope: how much of the suite is run.
        run_job: runs the job in a cell.

    Returns:
        The result. Its `status` is `not_graded` when the grader failed twice; that is no zero. It is in doubt when the
        machine held up, twice, what ran in real time.

    Raises:
        UsageError: there is no such path or assignment.
        IsolationError: this machine cannot isolate the submission so.
    """
    suite = suites.hidden(assignment)
    if not path.exists():
        raise UsageError(f"{path}: there is no such file or folder")
    require(isolation)

    with new_result(out) as folder:

        def job_in(scratch: Path) -> Job:
            return Job(path.resolve(), assignment, student, seed, folder.resolve(), scratch, isolation, scope)

        def grade() -> Result | None:
            return _grade(lambda: run_job(job_in, isolation), folder)

        with _machine.shared():
            result = grade()
        if result is not None and result.in_doubt:
            with _machine.exclusive():
                result = grade()
        if result is None:
            result = not_graded(suite, student, seed, isolation, FAILED)
            write_json(folder / RESULT, result.to_json())
    return result


def _grade(run: Callable[[], CellReport], folder: Path) -> Result | None:
    """Return a worker's result; None if it failed twice, and then `folder` has its log."""
    report = CellReport(Ending.EXITED, 0, "")
    for _ in range(TRIES):
        empty(folder)
        report = run()
        if report.returncode == 0 and (folder / RESULT).is_file():
            return from_json(json.loads((folder / RESULT).read_text()), source=str(folder / RESULT))
    # Never part of the result: its traceback may quote a hidden check, and results become feedback.
    (folder / LOG).write_text(f"The worker ended: {report.ending.value}, {report.returncode}.\n{report.output}")
    return None


def _worker(job: Job) -> list[str]:
    return [sys.executable, "-m", "autograder.grading.worker", job.to_json()]


def not_graded(suite: Suite, student: str, seed: int, isolation: Tier, why: str) -> Result:
    """Return the result of a submission on which the grader failed: `why` says what failed. It is no zero."""
    sentence = (
        f"{why} This is no zero: an instructor has to grade it again. {LOG}, beside the result, says what happened."
    )
    result = refused(suite, student, seed, isolation, Diagnosis(Kind.NOT_GRADED, sentence))
    checks = tuple(replace(check, message="not graded") for check in result.checks)
    return replace(result, status=Status.NOT_GRADED, checks=checks, build=None, phases={})


def refused(suite: Suite, student: str, seed: int, isolation: Tier, diagnosis: Diagnosis) -> Result:
    """Return the result of a submission that is unclear: intake refused it, for this reason."""
    return Result(
        assignment=suite.assignment,
        student=student,
        submission_sha256="0" * 64,
        suite_version=suite.version,
        files_digest=suite.files_digest,
        seed=seed,
        isolation=isolation.value,
        checks=tuple(CheckResult.not_checked(check, diagnosis.sentence) for check in suite.checks),
        max_score=suite.max_score,
        started=datetime.now(timezone.utc).isoformat(timespec="seconds"),
        seconds=0.0,
        status=Status.UNCLEAR,
        diagnosis=diagnosis,
        build=Build(False, 0.0, log=diagnosis.detail),
        phases={"intake": 0.0},
    )
