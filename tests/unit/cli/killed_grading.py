"""A grading of a class that kills itself, as `kill -9` does, before a chosen change to a file of its results.

It runs in a separate process. The workers are replaced; the code that writes and replaces results is real.
"""

from __future__ import annotations

import io
import json
import os
import signal
import sys
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from autograder import cli
from autograder.grade import grade_submission
from autograder.grade.job import Job
from autograder.result.model import Artifact, CheckResult, Result
from autograder.run.sandbox.process import ExitReason
from autograder.run.sandbox.worker_sandbox import WorkerReport
from autograder.submission.intake import read_submission
from autograder.suite import Outcome
from autograder.suite.suites import Suite

CHAPTER = "02_nodes"
NOTEBOOK = b'{"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}'
# The audit events of changes to files, with the positions of the paths among their arguments.
CHANGES = {"os.rename": (0, 1), "os.remove": (0,), "os.mkdir": (0,), "os.rmdir": (0,), "open": (0,)}
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT  # flags of a file that is opened to be changed


class Worker:
    """Replaces the workers: fails the given checks of each student, and passes all others."""

    def __init__(self, failed_checks: Mapping[str, tuple[str, ...]]) -> None:
        self._failed_checks = failed_checks

    def __call__(self, job: Job) -> WorkerReport:
        suite, failed_checks = job.suite, self._failed_checks[job.student]
        checks = tuple(
            CheckResult.of(check, Outcome.FAILED if check.id in failed_checks else Outcome.PASSED)
            for check in suite.checks
        )
        result = Result(
            assignment=job.assignment,
            student=job.student,
            submission_sha256=read_submission(job.path, job.assignment).sha256,
            suite_version=suite.version,
            files_digest=suite.files_digest,
            seed=job.seed,
            isolation=job.isolation.value,
            checks=checks,
            max_score=suite.max_score,
            started="2026-05-04T09:00:00+00:00",
            seconds=1.0,
            artifacts=(Artifact("nan.png", "track", "0" * 64, "nan"),),  # without a run: its player is slow to import
        )
        picture = io.BytesIO()
        Image.new("RGB", (8, 8)).save(picture, "PNG")
        files = {"nan.png": picture.getvalue(), "notebook.ipynb": NOTEBOOK}
        return WorkerReport(ExitReason.EXITED, 0, "", {**files, "result.json": json.dumps(result.to_json()).encode()})


def grade(
    folder: Path, failed_checks: Mapping[str, tuple[str, ...]], version: str, *options: str, kill_at: int = -1
) -> None:
    """Grade the class in `folder`, and append what is printed to the file `printed` in it.

    Args:
        folder: holds the folder `class`, and gets the folder `results`.
        failed_checks: the checks that each student fails.
        version: the version of the suite.
        options: further options of the command.
        kill_at: the index of the change to the results before which the process kills itself, or -1 to let it
            complete. The file `changes` then contains the number of changes.
    """
    results, changes = folder / "results", 0
    printed = os.open(folder / "printed", os.O_WRONLY | os.O_CREAT | os.O_APPEND)

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal changes
        if event not in CHANGES or (event == "open" and not arguments[2] & WRITING):
            return
        if any(str(arguments[position]).startswith(str(results)) for position in CHANGES[event]):
            if changes == kill_at:
                if event == "open" and arguments[2] & os.O_TRUNC and Path(arguments[0]).exists():
                    os.truncate(arguments[0], 0)  # as if it were killed before it could write
                os.kill(os.getpid(), signal.SIGKILL)
            changes += 1

    patch = pytest.MonkeyPatch()
    patch.setattr("autograder.grade.batch.grade_submission", partial(grade_submission, run_job=Worker(failed_checks)))
    patch.setattr(Suite, "version", property(lambda suite: version))
    os.dup2(printed, 1)
    words = ("grade", str(folder / "class"), "--assignment", CHAPTER, "--out", str(results), "-j", "1")
    sys.addaudithook(hook)
    try:
        cli.main([*words, "--isolation", "process", *options])
    finally:
        (folder / "changes").write_text(str(changes))
