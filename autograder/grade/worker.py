"""The worker: the trusted process that grades one submission inside its sandbox.

    python -m autograder.grade.worker JOB DESCRIPTOR

It imports no student code, which runs in sandboxes inside this one. It sends `result.json` and the pictures over the
connection with this descriptor. If the grader fails, it ends with a traceback instead.
"""

from __future__ import annotations

import subprocess
import sys
import time
import traceback
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from datetime import datetime, timezone
from multiprocessing.connection import Connection
from pathlib import Path

from autograder import course_paths
from autograder.diagnosis import OK, Diagnosis
from autograder.exceptions import GraderError, StudentError
from autograder.grade.job import Job
from autograder.grade.plugin import GradingPlugin, run
from autograder.grade.store import LOG, NOTEBOOK, RESULT
from autograder.result.artifacts import Artifacts
from autograder.result.model import Build, CheckResult, Result, Status, write_json
from autograder.ros import activate
from autograder.ros.domains import Domain
from autograder.ros.launch_packages import describe_launch
from autograder.run import patience
from autograder.run.sandbox import line
from autograder.run.sandbox.isolation import Isolation
from autograder.run.sandbox.launcher import restore_sigint
from autograder.run.sandbox.limits import RESULT_FILES
from autograder.run.sandbox.messages import send_message, send_tree
from autograder.run.sandbox.trees import read_tree
from autograder.run.time_record import REAL
from autograder.run.workspace import Workspace
from autograder.submission.intake import write_tree
from autograder.submission.reading import reading

_NO_DIGEST = "0" * 64


class Grading:
    """Grades one submission, from its files to a result."""

    def __init__(self, job: Job) -> None:
        self._job, self._suite = job, job.suite
        self._folder = job.scratch / "assignment"
        patience.begin(job.seconds)
        home = job.scratch / "home"
        home.mkdir(parents=True)
        # Without a network namespace, only separate domains keep two submissions apart.
        domain = 0 if job.isolation is Isolation.BUBBLEWRAP else Domain().number
        self._workspace = Workspace(job.scratch / "ws", activate(), home, domain=domain)
        self._artifacts = Artifacts(job.out, disabled=not job.options.pictures, recordings=job.options.recordings)
        self._phases: dict[str, float] = {}
        self._sha256 = _NO_DIGEST
        self._status = Status.UNCLEAR  # until the submission has been read
        self._notices: tuple[str, ...] = ()
        self._unused: tuple[str, ...] = ()
        self._build: Build | None = None
        self._builds: Mapping[str, Diagnosis] = {}
        self._unjudged: dict[str, str] = {}

    def grade(self) -> Result:
        """Execute all phases. A StudentError ends the grading early, with a diagnosis."""
        start, started = time.monotonic(), datetime.now(timezone.utc).isoformat(timespec="seconds")
        results: dict[str, CheckResult] = {}
        try:
            build_diagnosis = self._prepare()
            check_diagnosis = self._check(results)
            diagnosis = check_diagnosis if build_diagnosis is OK else build_diagnosis
        except StudentError as error:
            diagnosis = error.diagnosis
            if error.__cause__ is not None:  # an exception that the code reading the data does not handle
                self._log(traceback.format_exception(error))
        if self._build is None and diagnosis is not OK:
            self._build = Build(False, self._phases.get("build", 0.0), log=diagnosis.detail)
        times = self._workspace.time_record
        return Result(
            assignment=self._job.assignment,
            student=self._job.student,
            submission_sha256=self._sha256,
            suite_version=self._suite.version,
            files_digest=self._suite.files_digest,
            launch=describe_launch(),
            seed=self._job.seed,
            isolation=self._job.isolation.value,
            checks=tuple(
                results.get(check.id) or CheckResult.not_checked(check, diagnosis.sentence)
                for check in self._suite.checks
            ),
            max_score=self._suite.max_score,
            started=started,
            seconds=round(time.monotonic() - start, 2),
            diagnosis=diagnosis,
            build=self._build,
            artifacts=tuple(self._artifacts.saved),
            status=self._status,
            phases=self._phases,
            notices=self._notices,
            unused=self._unused,
            time=times.time,
            time_note=times.explain(),
            unjudged=tuple(self._unjudged),
            held_up=round(times.longest_wait, 6) if times.time == REAL else 0.0,
        )

    def _prepare(self) -> Diagnosis:
        """Read the submission, run its notebook and build it; return the diagnosis of a build that may fail."""
        from autograder.building.build import build_workspace
        from autograder.building.prebuilt import copy_prebuilt
        from autograder.submission import intake

        with self._phase("intake"), reading("Your submission"):
            submission = intake.read_submission(self._job.path, self._job.assignment)
            self._sha256, self._notices, self._unused = submission.sha256, submission.notices, submission.unused
            packages = submission.packages
            self._status = Status.GRADED
        if packages is None and submission.notebook is not None:
            with self._phase("notebook"), reading("Your notebook, or a file that it wrote,"):
                # Jupyter is slow to import, and not every submission needs it.
                from autograder.grade import run_notebook

                write_tree(submission.extra, self._folder)
                packages_before = intake.with_given_packages(submission, self._job.assignment)
                write_tree(packages_before, self._folder / "ws" / "src")
                original = course_paths.source_notebook(self._job.assignment)
                run_notebook.run(submission.notebook, original, self._folder, self._workspace, self._job.out / NOTEBOOK)
                # The notebook could write links and devices, but only plain files are read.
                written_files = intake.read_packages(self._folder / "ws")
                self._clear()
                counted = intake.graded_packages(submission, written_files, self._job.assignment)
                packages, self._notices = counted.packages, counted.notices
        assert packages is not None, "only a notebook creates packages that were not submitted"
        source = self._workspace.root / "src"
        with reading("Your submission"):
            write_tree(packages, source)
        with self._phase("build"), reading("Your packages, or a file from their build,"):
            if prebuilt := self._job.options.prebuilt:
                outcome = copy_prebuilt(Path(prebuilt), self._workspace, self._suite.packages)
            else:
                outcome = build_workspace(self._workspace, self._suite.packages, may_fail=self._suite.build_may_fail)
            # A set-up script could also write to the sources, and checks have to read the submitted ones.
            subprocess.run(["rm", "-rf", "--", source], check=True)
            write_tree(packages, source)
        self._build, self._builds = outcome.build, outcome.diagnoses
        return outcome.diagnosis

    def _clear(self) -> None:
        """Remove the files that the notebook wrote, at any depth, so that a full disk has free space."""
        subprocess.run(["rm", "-rf", "--", self._folder, self._workspace.scratch], check=True)
        self._workspace.scratch.mkdir()

    def _check(self, results: dict[str, CheckResult]) -> Diagnosis:
        plugin = GradingPlugin(
            self._workspace, self._job.seed, self._artifacts, self._builds, self._job.options, self._job.is_last_try
        )
        with self._phase("checks"):
            run(self._suite.files, plugin)
        ids = self._job.options.only or [check.id for check in self._suite.checks]
        missing_ids = set(ids) - set(plugin.results)
        if missing_ids and not plugin.failures and not plugin.is_finished:
            plugin.failures.append(f"no record of {', '.join(sorted(missing_ids))}")
        if plugin.failures:
            raise GraderError("\n".join(plugin.failures))
        results.update(plugin.results)
        self._unjudged = plugin.unjudged
        if plugin.unjudged:
            self._log(plugin.unjudged.values())
        return plugin.diagnosis

    def _log(self, tracebacks: Iterable[str]) -> None:
        """Write tracebacks for the instructor. They are not part of the result, because they quote hidden checks."""
        self._job.out.mkdir(parents=True, exist_ok=True)
        (self._job.out / LOG).write_text("\n".join(tracebacks), errors="backslashreplace")

    @contextmanager
    def _phase(self, name: str) -> Iterator[None]:
        start = time.monotonic()
        try:
            yield
        finally:
            self._phases[name] = round(time.monotonic() - start, 3)


def prepare() -> None:
    """Prepare this process for grading: let it receive interrupts, and make ROS importable."""
    restore_sigint()
    activate()


def work(job: Job) -> None:
    """Grade a job, and send the files of its result over this process's connection."""
    job.out.mkdir(parents=True, exist_ok=True)
    write_json(job.out / RESULT, Grading(job).grade().to_json())
    with line.exclusive_line() as connection:
        if connection is not None:
            send_message(connection, {"do": "result"})
            send_tree(connection, read_tree(job.out, RESULT_FILES))


def main() -> None:
    """Grade the job that the command line contains."""
    job = Job.from_json(sys.argv[1])
    line.set_line(Connection(int(sys.argv[2])))
    prepare()
    work(job)


if __name__ == "__main__":
    main()
