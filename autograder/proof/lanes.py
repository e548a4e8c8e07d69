"""The trusted end of fork servers: one a lane, started when it is needed, and again when it has failed."""

from __future__ import annotations

import json
import os
import queue
import selectors
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from dataclasses import replace
from pathlib import Path

from autograder.grading.job import MEMORY, Job
from autograder.sandbox.cell import CellReport, in_cell
from autograder.sandbox.limits import GRADING_CELL, PROOF_CELL
from autograder.sandbox.process import Ending
from autograder.sandbox.tiers import Tier, require

_TICK = 0.25  # s between two looks at whether a silent server still lives


class Lanes:
    """Grades submissions in a few cells that are used again and again; a context manager.

    It is called as `pipeline.in_own_cell` is. For submissions that are the course's own, see `forkserver`.

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
            report = lane.grade(replace(job_in(lane.scratch / "job"), memory=lane.scratch / MEMORY))
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
        their_jobs, self._jobs = os.pipe()
        self._replies, their_replies = os.pipe()
        for descriptor in (self._jobs, self._replies):
            self._stack.callback(os.close, descriptor)
        theirs = (their_jobs, their_replies)

        def command(scratch: Path) -> list[str]:
            server = [sys.executable, "-m", "autograder.proof.fork_server", str(scratch)]
            return [*server, *map(str, theirs)]

        try:
            cell = in_cell(command, tier, PROOF_CELL, pass_fds=theirs)
            self._process, self.scratch = self._stack.enter_context(cell)
        except BaseException:
            self._stack.close()
            raise
        finally:
            for descriptor in theirs:
                os.close(descriptor)

    def grade(self, job: Job) -> CellReport:
        """Order one job and wait for its end; any ending but `exited` is the server's, which is of no more use."""
        with suppress(BrokenPipeError):  # of a server that is no more; its end is seen below
            os.write(self._jobs, job.to_json().encode() + b"\n")
        reply, deadline = b"", time.monotonic() + GRADING_CELL.wall_seconds
        with selectors.DefaultSelector() as selector:
            selector.register(self._replies, selectors.EVENT_READ)
            while not reply.endswith(b"\n"):
                if selector.select(_TICK):
                    chunk = os.read(self._replies, 65536)
                    reply += chunk
                    if not chunk:
                        self._process.wait(GRADING_CELL.wall_seconds)
                if self._process.ending is not None or time.monotonic() > deadline:
                    self._process.kill()
                    ending = self._process.ending or Ending.WALL_TIME
                    ending = Ending.KILLED if ending is Ending.EXITED else ending
                    return CellReport(ending, self._process.returncode or 1, self._process.output)
        said = json.loads(reply)
        return CellReport(Ending.EXITED, said["status"], said["output"])

    def close(self) -> None:
        """End the server and all that is below it."""
        self._stack.close()
