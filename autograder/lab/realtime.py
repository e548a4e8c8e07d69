"""A lab in real time: the program runs as `ros2 run` would start it, and can be sent signals."""

from __future__ import annotations

import signal
import sys
import time
from types import TracebackType

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.lab.meeting import Lab
from autograder.lockstep.failures import diagnose_ending, diagnose_output, stuck
from autograder.sandbox import Process
from autograder.sandbox.launcher import launch

START_SECONDS = 60.0  # real time from start until the node is seen, generous for a machine that is busy
SETTLE_SECONDS = 3.0  # real time for a node's endpoints to be seen, once the node is


class RealtimeLab(Lab):
    """A program in real time, for what cannot be stepped: signals, own threads, whole processes."""

    def _start(self) -> None:
        self._began = time.monotonic()
        self._process = launch([sys.executable, str(self._program), *self._arguments], self._sandbox)
        if not self.wait_for(lambda: self._alive() and bool(self.nodes()), START_SECONDS):
            raise StudentError(stuck(Kind.NEVER_STARTED, START_SECONDS, self._process.output))

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.__exit__(kind, error, trace)
        super().__exit__(kind, error, trace)

    @property
    def process(self) -> Process:
        return self._process

    @property
    def now_ns(self) -> int:
        return int(self.node.get_clock().now().nanoseconds)

    @property
    def seconds(self) -> float:
        return time.monotonic() - self._began

    def step(self, dt_ns: int) -> None:
        """Listen for `dt_ns` nanoseconds of real time."""
        end = time.monotonic() + dt_ns / 1e9
        while (left := end - time.monotonic()) > 0:
            self._alive()
            self._spin(min(left, 0.05))

    def stop(self, number: signal.Signals, seconds: float) -> int | None:
        """Send a signal; return the exit status, or None if the program is still there after `seconds`."""
        self._process.signal(number)
        return self._process.returncode if self._process.wait(seconds) else None

    def _alive(self) -> bool:
        if self._process.ending is not None:
            raise StudentError(diagnose_output(self._process) or diagnose_ending(self._process))
        return True

    def _topics(self) -> set[str]:
        wanted = {*self._offers, *self._listens}
        self.wait_for(lambda: self._alive() and all(self._peers(topic) for topic in wanted), SETTLE_SECONDS)
        return {topic for topic in wanted if self._peers(topic)}

    def _connected(self, topics: set[str]) -> bool:
        # The program's own view cannot be asked for; the grader's subscriptions are matched once they see a publisher.
        return all(self.node.count_publishers(topic) for topic in topics & set(self._listens))
