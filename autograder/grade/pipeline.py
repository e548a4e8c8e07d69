"""Grading one submission: a worker in a cell, and one retry when the grader itself failed.

A program that cannot be stepped may lose a point that it deserves on a busy machine. Where the machine was seen to hold
it up and it lost a point, the submission is graded once more while this process grades nothing else.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timezone
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.grade.answer import AnswerError, Asked, checked
from autograder.grade.job import ALL, Job, Scope
from autograder.grade.machine_lock import MachineLock
from autograder.grade.own_cell import in_own_cell
from autograder.grade.store import LOG, RESULT, empty, new_result
from autograder.result.model import Build, CheckResult, Result, Status, write_json
from autograder.run.sandbox import Tier, require
from autograder.run.sandbox.cell import CellReport
from autograder.run.sandbox.limits import GRADING_CELL
from autograder.run.sandbox.process import Ending
from autograder.suite import suites
from autograder.suite.suites import Suite

TRIES = 2
LEAST = 1 / 4  # of the time that a submission has: a try with less would only show that it is too little
DEFAULT_SEED = 2026  # of every grading that names none, so that the ways to grade draw the same inputs

RunJob = Callable[[Job, float], CellReport]
"""Runs a job in a cell, for at most so many seconds."""

Run = Callable[[float, bool], CellReport]
"""Makes a try, for at most so many seconds; it is told whether this is the last one."""


_machine = MachineLock()


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
    seconds: float = GRADING_CELL.wall_seconds,
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
        seconds: real time for all of it: a second grading has what the first has left.

    Returns:
        The result. Its `status` is `not_graded` when the grader failed twice, or did not end in time; that is no zero.
        It is in doubt when the machine held up, twice, what ran in real time.

    Raises:
        UsageError: there is no such path or assignment.
        IsolationError: this machine cannot isolate the submission so.
    """
    suite = suites.hidden(assignment)
    if not path.exists():
        raise UsageError(f"{path}: there is no such file or folder")
    require(isolation)

    job = Job(path.resolve(), assignment, student, seed, isolation, scope)
    asked = Asked(suite, student, seed, isolation.value)
    budget = Budget(seconds)
    with new_result(out) as folder:

        def grade() -> tuple[Result | None, str]:
            return _grade(lambda left, last: run_job(replace(job, last=last), left), asked, folder, budget)

        with _machine.shared():
            result, why = grade()
        if result is not None and result.in_doubt and budget.is_enough:
            with _machine.exclusive():
                result, why = grade()
        if result is None:
            result = not_graded(suite, student, seed, isolation, why)
        write_json(folder / RESULT, result.to_json())
    return result


class Budget:
    """The real time that one submission has, for all its gradings together."""

    def __init__(self, seconds: float) -> None:
        self.seconds = self.left = seconds

    @property
    def is_enough(self) -> bool:
        """Whether a grading may begin."""
        return self.left >= LEAST * self.seconds

    def spend(self, run: Run, last: bool) -> CellReport:
        """Run something with the time that is left; what waits for its turn on the machine costs nothing."""
        began = time.monotonic()
        try:
            return run(self.left, last)
        finally:
            self.left -= time.monotonic() - began


def _grade(run: Run, asked: Asked, folder: Path, budget: Budget) -> tuple[Result | None, str]:
    """Return a worker's result, whose files are in `folder`; None and why if there is none, and then its log is there.

    A worker may have been taken over. Nothing of its answer is used before it was checked.
    """
    said, why, tries = "", "", 0
    while tries < TRIES and budget.is_enough:
        tries += 1
        empty(folder)
        report = budget.spend(run, tries == TRIES)
        said = f"The worker ended: {report.ending.value}, {report.returncode}.\n{report.output}"
        why = f"The grader failed on this submission{f', {tries} times' if tries > 1 else ''}."
        if report.ending is Ending.WALL_TIME:
            why = f"The grading did not end within {budget.seconds / 60:.0f} minutes."
        if report.returncode == 0 and report.files:
            try:
                result = checked(report.files, asked)
            except AnswerError as error:
                said += f"\n{error}"
                continue
            for name, content in report.files.items():
                (folder / name).write_bytes(content)
            return result, ""
    # Never part of the result: its traceback may quote a hidden check, and results become feedback.
    (folder / LOG).write_text(said)
    return None, why


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
