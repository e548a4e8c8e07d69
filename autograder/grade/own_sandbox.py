"""Grades one submission in its own worker sandbox, and defines which files its worker can read there."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from dataclasses import replace
from multiprocessing import Pipe
from pathlib import Path

from autograder import course_paths
from autograder.building.bundle_server import serve_worker
from autograder.grade.job import Job
from autograder.run.sandbox.bubblewrap import OUT
from autograder.run.sandbox.limits import GRADING_WORKER
from autograder.run.sandbox.messages import MessageError
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.worker_sandbox import WorkerReport, in_worker_sandbox, path_in_sandbox, wait_and_report
from autograder.suite import fingerprint

GRACE = 30.0  # s that a worker gets beyond its time, to stop its programs and report


def run_in_own_sandbox(job: Job) -> WorkerReport:
    """Run a job in a worker with its own sandbox; return a report with the files of the result."""
    own_end, worker_end = Pipe()

    def command(scratch: Path) -> list[str]:
        path = path_in_sandbox(job.path, job.isolation, scratch)
        return _worker_command(replace(job, path=path, scratch=scratch, out=scratch / OUT), worker_end.fileno())

    limits = replace(GRADING_WORKER, wall_seconds=job.seconds + GRACE)
    with own_end, ExitStack() as stack:
        with worker_end:
            sandbox = in_worker_sandbox(command, job.isolation, limits, view=view(job), pass_fds=(worker_end.fileno(),))
            process, _ = stack.enter_context(sandbox)
        try:
            files, _ = serve_worker(own_end, job.isolation, lambda: process.exit_reason is not None)
            return replace(wait_and_report(process), files=files)
        except MessageError as error:
            process.kill()
            report = wait_and_report(process)
            return replace(report, returncode=report.returncode or 1, output=f"{report.output}\n{error}")


def view(job: Job) -> View:
    """Return the files that a job's worker sees: the submission, its chapter, and the files that its suite reads."""
    chapter = course_paths.chapter(job.assignment)
    suite_paths = fingerprint.suite_paths(job.assignment, job.suite.reads)
    prebuilt = (Path(job.options.prebuilt),) if job.options.prebuilt else ()
    return View(shown=(chapter, *suite_paths, *prebuilt), submitted=(job.path,))


def _worker_command(job: Job, descriptor: int) -> list[str]:
    return [sys.executable, "-m", "autograder.grade.worker", job.to_json(), str(descriptor)]
