"""A pool of grading workers. Each is a fork server in a cell; it starts on first use, and again after a failure."""

from __future__ import annotations

import json
import queue
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from multiprocessing import Pipe
from pathlib import Path

from autograder.grading.job import Job
from autograder.sandbox.cell import CellReport, in_cell
from autograder.sandbox.limits import GRADING_CELL, PROOF_CELL
from autograder.sandbox.process import Ending
from autograder.sandbox.tiers import Tier, require

_TICK = 0.25  # s between two tests whether a silent server still runs


class WorkerPool:
    """Grades submissions with a few workers, each in one cell for many submissions; a context manager.

    It is called as `pipeline.in_own_cell` is. For submissions that are the course's own, see `fork_server`.

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

    def __call__(self, job_in: Callable[[Path], Job], tier: Tier) -> CellReport:
        """Grade one submission; `job_in` makes its job from a scratch folder."""
        worker = self._idle.get()
        try:
            worker = worker or self._starter.submit(_Worker, self.tier).result()
            report = worker.grade(job_in(worker.scratch / "job"))
            if report.ending is not Ending.EXITED:
                worker.close()
                worker = None
            return report
        finally:
            self._idle.put(worker)


class _Worker:
    """A fork server in a cell."""

    def __init__(self, tier: Tier) -> None:
        self._stack = ExitStack()
        ours, theirs = Pipe()
        self._server = self._stack.enter_context(ours)

        def command(scratch: Path) -> list[str]:
            return [sys.executable, "-m", "autograder.proof.fork_server", str(scratch), str(theirs.fileno())]

        with theirs:
            cell = in_cell(command, tier, PROOF_CELL, pass_fds=(theirs.fileno(),))
            self._process, self.scratch = self._stack.enter_context(cell)

    def grade(self, job: Job) -> CellReport:
        """Send one job and wait for its result. If the ending is not `exited`, the worker cannot be used again."""
        deadline = time.monotonic() + GRADING_CELL.wall_seconds
        try:
            self._server.send_bytes(job.to_json().encode())
            while not self._server.poll(_TICK):
                if self._process.ending is not None or time.monotonic() > deadline:
                    return self._dead()
            reply = json.loads(self._server.recv_bytes())
        except (EOFError, OSError):  # the server is no more
            self._process.wait(GRADING_CELL.wall_seconds)
            return self._dead()
        return CellReport(Ending.EXITED, reply["status"], reply["output"])

    def _dead(self) -> CellReport:
        self._process.kill()
        ending = self._process.ending or Ending.WALL_TIME
        ending = Ending.KILLED if ending is Ending.EXITED else ending
        return CellReport(ending, self._process.returncode or 1, self._process.output)

    def close(self) -> None:
        """End the server and all that is below it."""
        self._stack.close()
