"""A pool of workers that grade. Each is a fork server in a sandbox, started on first use and after each failure."""

from __future__ import annotations

import hashlib
import queue
import shutil
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from multiprocessing import Pipe
from pathlib import Path
from tempfile import TemporaryDirectory

from autograder import course_paths
from autograder.building.bundle_server import serve_worker
from autograder.grade.job import Job
from autograder.grade.own_sandbox import GRACE
from autograder.run.sandbox.bubblewrap import OUT
from autograder.run.sandbox.isolation import Isolation, require
from autograder.run.sandbox.limits import VERIFICATION_WORKER
from autograder.run.sandbox.messages import MessageError
from autograder.run.sandbox.process import ExitReason
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.worker_sandbox import WorkerReport, copy_submission, in_worker_sandbox

_EXIT_TIMEOUT = 5.0  # s; how long a server that no longer replies may take to exit


class WorkerPool:
    """Grades submissions with a fixed number of workers. Each worker grades many submissions in one sandbox.

    A pool is a context manager, and is called like `own_sandbox.run_in_own_sandbox`. Use it only for submissions that
    the course itself contains; see `fork_server`.

    Args:
        isolation: the isolation level of each worker sandbox.
        count: the number of workers, which is also how many submissions are graded at the same time.

    Raises:
        IsolationError: this machine does not support the isolation level.
    """

    def __init__(self, isolation: Isolation, count: int) -> None:
        self.isolation, self.count = require(isolation), count
        # The kernel kills a sandbox when the thread that started it ends. This thread lives as long as the workers.
        self._starter = ThreadPoolExecutor(1)
        self._idle: queue.SimpleQueue[_Worker | None] = queue.SimpleQueue()
        for _ in range(count):
            self._idle.put(None)

    def __enter__(self) -> WorkerPool:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in [self._idle.get() for _ in range(self.count)]:
            if worker is not None:
                worker.close()
        self._starter.shutdown()

    def __call__(self, job: Job) -> WorkerReport:
        """Grade one submission, and return a report with the files that its worker produced."""
        worker = self._idle.get()
        try:
            worker = worker or self._starter.submit(_Worker, self.isolation).result()
            report = worker.grade(job)
            # External events can also break a sandbox, for example if apt replaces a file that is mounted in it.
            if report.exit_reason is not ExitReason.EXITED or report.returncode:
                worker.close()
                worker = None
            return report
        finally:
            self._idle.put(worker)


class _Worker:
    """A fork server in a sandbox that sees the whole course and one folder for submissions."""

    def __init__(self, isolation: Isolation) -> None:
        self._stack = ExitStack()
        own_end, server_end = Pipe()
        self._server, self._isolation = self._stack.enter_context(own_end), isolation
        # Files that are written after the sandbox has started appear in it only if their folder was mounted from the
        # start. The sandbox's user must be able to read them.
        self._shared = Path(self._stack.enter_context(TemporaryDirectory(prefix="verification-shared-")))
        self._shared.chmod(0o755)

        def command(scratch: Path) -> list[str]:
            module = "autograder.author.verification.fork_server"
            return [sys.executable, "-m", module, str(scratch), str(server_end.fileno())]

        view = View(shown=(*{course_paths.ROOT, course_paths.course().root}, self._shared))
        with server_end:
            sandbox = in_worker_sandbox(
                command, isolation, VERIFICATION_WORKER, view=view, pass_fds=(server_end.fileno(),)
            )
            self._process, self._scratch = self._stack.enter_context(sandbox)

    def grade(self, job: Job) -> WorkerReport:
        """Send one job and wait for its result. Close the worker unless the report's exit reason is `exited`."""
        deadline = time.monotonic() + job.seconds + GRACE
        scratch = self._scratch / "job"
        with TemporaryDirectory(dir=self._shared) as folder:
            Path(folder).chmod(0o755)
            path = Path(folder, job.path.name)
            copy_submission(job.path, path)
            prebuilt = job.options.prebuilt
            options = replace(job.options, prebuilt=prebuilt and str(self._copy_to_shared(Path(prebuilt))))
            remote_job = replace(job, path=path, options=options, scratch=scratch, out=self._scratch / OUT)
            try:
                self._server.send_bytes(remote_job.to_json().encode())
                is_over = lambda: self._process.exit_reason is not None or time.monotonic() > deadline  # noqa: E731
                files, reply = serve_worker(self._server, self._isolation, is_over)
            except (MessageError, OSError):
                files, reply = {}, {}
        return WorkerReport(ExitReason.EXITED, reply["status"], reply["output"], files) if reply else self._stop()

    def _copy_to_shared(self, built_workspace: Path) -> Path:
        """Copy a built workspace to the shared folder unless an earlier job did, and return the path of the copy."""
        copy = self._shared / f"built-{hashlib.sha256(str(built_workspace).encode()).hexdigest()[:16]}"
        if not copy.exists():
            shutil.copytree(built_workspace, copy, symlinks=True)
        return copy

    def _stop(self) -> WorkerReport:
        """Stop a server that did not reply, and return a report with the reason."""
        self._process.wait(_EXIT_TIMEOUT)
        self._process.kill()
        exit_reason = self._process.exit_reason or ExitReason.WALL_TIME
        exit_reason = ExitReason.KILLED if exit_reason is ExitReason.EXITED else exit_reason
        return WorkerReport(exit_reason, self._process.returncode or 1, self._process.output)

    def close(self) -> None:
        """Stop the server and all its child processes."""
        self._stack.close()
