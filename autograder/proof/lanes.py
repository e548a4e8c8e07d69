"""The trusted end of fork servers: one a lane, started when it is needed, and again when it has failed."""

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

_TICK = 0.25  # s between two looks at whether a silent server still lives


class Lanes:
    """Grades submissions in a few cells that are used again and again; a context manager.

    It is called as `pipeline.in_own_cell` is. For submissions that are the course's own, see `fork_server`.

    Args:
        tier: how strongly a cell is kept apart.
        count: how many there are, for as many calls at once.

    Raises:
        IsolationError: this machine cannot give the tier.
    """

    def __init__(self, tier: Tier, count: int) -> None:
        self.tier, self.count = require(tier), count
        # The kernel ends a cell with the thread that started it. This one lives as long as the lanes do.
        self._starter = ThreadPoolExecutor(1)
        self._idle: queue.SimpleQueue[_Lane | None] = queue.SimpleQueue()
        for _ in range(count):
            self._idle.put(None)

    def __enter__(self) -> Lanes:
        return self

    def __exit__(self, *_: object) -> None:
        for lane in [self._idle.get() for number in range(self.count)]:
            if lane is not None:
                lane.close()
        self._starter.shutdown()

    def __call__(self, job_in: Callable[[Path], Job], tier: Tier) -> CellReport:
        """Grade one submission; `job_in` makes its job from a scratch folder."""
        lane = self._idle.get()
        try:
            lane = lane or self._starter.submit(_Lane, self.tier).result()
            report = lane.grade(job_in(lane.scratch / "job"))
            if report.ending is not Ending.EXITED:
                lane.close()
                lane = None
            return report
        finally:
            self._idle.put(lane)


class _Lane:
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
        """Order one job and wait for its end; any ending but `exited` is the server's, which is of no more use."""
        deadline = time.monotonic() + GRADING_CELL.wall_seconds
        try:
            self._server.send_bytes(job.to_json().encode())
            while not self._server.poll(_TICK):
                if self._process.ending is not None or time.monotonic() > deadline:
                    return self._dead()
            said = json.loads(self._server.recv_bytes())
        except (EOFError, OSError):  # the server is no more
            self._process.wait(GRADING_CELL.wall_seconds)
            return self._dead()
        return CellReport(Ending.EXITED, said["status"], said["output"])

    def _dead(self) -> CellReport:
        self._process.kill()
        ending = self._process.ending or Ending.WALL_TIME
        ending = Ending.KILLED if ending is Ending.EXITED else ending
        return CellReport(ending, self._process.returncode or 1, self._process.output)

    def close(self) -> None:
        """End the server and all that is below it."""
        self._stack.close()
