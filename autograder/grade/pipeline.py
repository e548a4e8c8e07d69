"""Grades one submission in a worker sandbox, and retries once if the grader itself failed.

On a busy machine, a program that runs in real time may lose a point that it deserves. If the machine delayed the
program and it lost a point, the submission is graded again while this process grades nothing else.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import datetime, timezone

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.grade.job import Job
from autograder.grade.machine_lock import MachineLock
from autograder.grade.own_sandbox import run_in_own_sandbox
from autograder.grade.reply import ReplyError, check_reply
from autograder.grade.store import LOG, write_result
from autograder.result.model import Build, CheckResult, Result, Status
from autograder.ros.launch_packages import describe_launch
from autograder.run.sandbox import require
from autograder.run.sandbox.process import ExitReason
from autograder.run.sandbox.worker_sandbox import WorkerReport
from autograder.suite import suites

TRIES = 2
MIN_SHARE = 1 / 4  # the part of a submission's time that a try needs; with less, it would only run out of time
DEFAULT_SEED = 2026  # for every grading without an explicit seed, so that all commands draw the same inputs

RunJob = Callable[[Job], WorkerReport]
"""Runs a job in a worker sandbox."""


_machine = MachineLock()


def grade_submission(job: Job, run_job: RunJob = run_in_own_sandbox) -> Result:
    """Grade one submission; `run_job` runs its worker. An old result is not removed before the new one is complete.

    Returns:
        The result. Its `status` is `not_graded` if the grader failed twice, or did not end in time. This is not a zero.
        It is in doubt if the machine delayed real-time programs in both tries.

    Raises:
        UsageError: the path or the assignment does not exist.
        IsolationError: this machine does not support the isolation level.
    """
    suites.hidden(job.assignment)
    if not job.path.exists():
        raise UsageError(f"{job.path}: there is no such file or folder")
    require(job.isolation)
    job.out.mkdir(parents=True, exist_ok=True)
    job, budget = replace(job, path=job.path.resolve()), Budget(job.seconds)
    with _machine.shared():
        result, files = _grade(job, run_job, budget)
    if result.in_doubt and budget.is_enough:
        with _machine.exclusive():
            result, files = _grade(job, run_job, budget)
    return write_result(job, result, files)


class Budget:
    """The real time that one submission has for all its gradings together."""

    def __init__(self, seconds: float) -> None:
        self.seconds = self.remaining = seconds

    @property
    def is_enough(self) -> bool:
        """Whether the remaining time is enough for another try."""
        return self.remaining >= MIN_SHARE * self.seconds

    def spend(self, job: Job, run_job: RunJob) -> WorkerReport:
        """Run a job in the remaining time, and subtract the time it takes. Waiting for the machine does not count."""
        start = time.monotonic()
        try:
            return run_job(replace(job, seconds=self.remaining))
        finally:
            self.remaining -= time.monotonic() - start


def _grade(job: Job, run_job: RunJob, budget: Budget) -> tuple[Result, Mapping[str, bytes]]:
    """Return a worker's result with its files. If it has none, return a result without marks, with the log.

    Students' code may have taken over the worker, so no part of its reply is used before it has been checked.
    """
    log, reason, tries = "", "", 0
    while tries < TRIES and budget.is_enough:
        tries += 1
        report = budget.spend(replace(job, is_last_try=tries == TRIES), run_job)
        log = f"The worker ended: {report.exit_reason.value}, {report.returncode}.\n{report.output}"
        reason = f"The grader failed on this submission{f', {tries} times' if tries > 1 else ''}."
        if report.exit_reason is ExitReason.WALL_TIME:
            reason = f"The grading did not end within {budget.seconds / 60:.0f} minutes."
        if report.returncode == 0 and report.files:
            try:
                return check_reply(report.files, job), report.files
            except ReplyError as error:
                log += f"\n{error}"
    return not_graded_result(job, reason, log)


def not_graded_result(job: Job, reason: str, log: str) -> tuple[Result, Mapping[str, bytes]]:
    """Return the result of a submission on which the grader failed, and its files. It is not a zero.

    `reason` is a sentence about the failure. The log is not part of the result, because its traceback may quote a
    hidden check, and students read results as feedback.
    """
    sentence = (
        f"{reason} This is not a zero: an instructor has to grade it again. "
        f"{LOG}, beside the result, says what happened."
    )
    result = unclear_result(job, Diagnosis(Kind.NOT_GRADED, sentence))
    checks = tuple(replace(check, message="not graded") for check in result.checks)
    result = replace(result, status=Status.NOT_GRADED, checks=checks, build=None, phases={})
    return result, {LOG: log.encode("utf-8", "backslashreplace")}


def unclear_result(job: Job, diagnosis: Diagnosis) -> Result:
    """Return the result of a submission that intake rejected as unclear."""
    suite = job.suite
    return Result(
        assignment=suite.assignment,
        student=job.student,
        submission_sha256="0" * 64,
        suite_version=suite.version,
        files_digest=suite.files_digest,
        launch=describe_launch(),
        seed=job.seed,
        isolation=job.isolation.value,
        checks=tuple(CheckResult.not_checked(check, diagnosis.sentence) for check in suite.checks),
        max_score=suite.max_score,
        started=datetime.now(timezone.utc).isoformat(timespec="seconds"),
        seconds=0.0,
        status=Status.UNCLEAR,
        diagnosis=diagnosis,
        build=Build(False, 0.0, log=diagnosis.detail),
        phases={"intake": 0.0},
    )
