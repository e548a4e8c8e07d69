"""A pool of grading workers. Each is a fork server in a cell; it starts on first use, and again after a failure."""

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

from autograder import layout
from autograder.building.keeper import attend
from autograder.grade.job import Job
from autograder.grade.own_cell import GRACE
from autograder.run.sandbox.cell import CellReport, copy_submission, in_cell
from autograder.run.sandbox.limits import PROOF_CELL
from autograder.run.sandbox.parcel import ParcelError
from autograder.run.sandbox.process import Ending
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.tiers import Tier, require

_TICK = 5.0  # s in which a server that is gone is seen to have ended


class WorkerPool:
    """Grades submissions with a few workers, each in one cell for many submissions; a context manager.

    It is called as `own_cell.in_own_cell` is. For submissions that are the course's own, see `fork_server`.

    Args:
        tier: the isolation of each worker's cell.
        count: number of workers; as many submissions can be graded at once.

    Raises:
        IsolationError: this machine cannot give the tier.
    """

    def __init__(self, tier: Tier, count: int) -> None:
        self.tier, self.count = require(tier), count
        # The kernel ends a cell with the thread that started it. This one lives as long as the workers do.
        self._starter = ThreadPoolExecutor(1)
        self._idle: queue.SimpleQueue[_Worker | None] = queue.SimpleQueue()
        for _ in range(count):
            self._idle.put(None)

    def __enter__(self) -> WorkerPool:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in [self._idle.get() for number in range(self.count)]:
            if worker is not None:
                worker.close()
        self._starter.shutdown()

    def __call__(self, job: Job) -> CellReport:
        """Grade one submission; report the files that its worker left."""
        worker = self._idle.get()
        try:
            worker = worker or self._starter.submit(_Worker, self.tier).result()
            report = worker.grade(job)
            if report.ending is not Ending.EXITED:
                worker.close()
                worker = None
            return report
        finally:
            self._idle.put(worker)


class _Worker:
    """A fork server in a cell, which sees the whole course, and one folder for what is handed in."""

    def __init__(self, tier: Tier) -> None:
        self._stack = ExitStack()
        ours, theirs = Pipe()
        self._server, self._tier = self._stack.enter_context(ours), tier
        # The cell cannot see what comes later, but in a folder that it sees. It has to be open to a user of its own.
        self._shown = Path(self._stack.enter_context(TemporaryDirectory(prefix="proof-shown-")))
        self._shown.chmod(0o755)

        def command(scratch: Path) -> list[str]:
            return [
                sys.executable,
                "-m",
                "autograder.author.verification.fork_server",
                str(scratch),
                str(theirs.fileno()),
            ]

        view = View(shown=(*{layout.ROOT, layout.course().root}, self._shown))
        with theirs:
            cell = in_cell(command, tier, PROOF_CELL, view=view, pass_fds=(theirs.fileno(),))
            self._process, self._scratch = self._stack.enter_context(cell)

    def grade(self, job: Job) -> CellReport:
        """Send one job and wait for its result. If the ending is not `exited`, the worker cannot be used again."""
        deadline = time.monotonic() + job.seconds + GRACE
        place = self._scratch / "job"
        with TemporaryDirectory(dir=self._shown) as folder:
            Path(folder).chmod(0o755)
            path = Path(folder, job.path.name)
            copy_submission(job.path, path)
            scope = replace(job.scope, built=job.scope.built and str(self._show(Path(job.scope.built))))
            told = replace(job, path=path, scope=scope, scratch=place, out=place / "out")
            try:
                self._server.send_bytes(told.to_json().encode())
                over = lambda: self._process.ending is not None or time.monotonic() > deadline  # noqa: E731
                files, reply = attend(self._server, self._tier, over)
            except (ParcelError, OSError):
                files, reply = {}, {}
        return CellReport(Ending.EXITED, reply["status"], reply["output"], files) if reply else self._dead()

    def _show(self, built: Path) -> Path:
        """Show the fork server a built workspace, which serves many jobs."""
        shown = self._shown / f"built-{hashlib.sha256(str(built).encode()).hexdigest()[:16]}"
        if not shown.exists():
            shutil.copytree(built, shown, symlinks=True)
        return shown

    def _dead(self) -> CellReport:
        self._process.wait(_TICK)
        self._process.kill()
        ending = self._process.ending or Ending.WALL_TIME
        ending = Ending.KILLED if ending is Ending.EXITED else ending
        return CellReport(ending, self._process.returncode or 1, self._process.output)

    def close(self) -> None:
        """End the server and all that is below it."""
        self._stack.close()
