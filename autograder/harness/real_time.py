"""A harness in real time: the programs run as if `ros2 run` had started them, and can receive signals."""

from __future__ import annotations

import signal
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import cpu_starvation
from autograder.harness.base import Harness, Program
from autograder.run.lockstep.failures import diagnose_exit, diagnose_no_answer, diagnose_output
from autograder.run.sandbox import Process
from autograder.run.sandbox.launcher import launch

START_SECONDS = 60.0  # maximum real time until the nodes are visible; it is long enough for a busy machine
GRACE_NS = 300_000_000  # real time in which the programs match the grader's endpoints; the programs cannot be asked
SETTLE_SECONDS = 3.0  # maximum real time from the discovery of a node to that of its endpoints


class RealTimeHarness(Harness):
    """Programs in real time, for what cannot be tested in steps: signals, threads and processes."""

    _running: Sequence[tuple[Program, Process]] = ()

    def _start(self) -> None:
        self._start_time = time.monotonic()
        for program, path in zip(self.programs, self._paths, strict=True):
            command = [sys.executable, str(path), *program.arguments]
            process = self.enter_context(launch(command, self._sandbox))
            self._running = [*self._running, (program, process)]
        is_up = self.wait_for(lambda: self._are_alive() and len(self.nodes()) >= len(self._running), START_SECONDS)
        if not is_up and len(self.nodes()) < len(self.running - self.optional):
            raise StudentError(diagnose_no_answer(Kind.NEVER_STARTED, f"{START_SECONDS:.0f} s", self.output))

    @property
    def processes(self) -> tuple[Process, ...]:
        return tuple(process for _, process in self._running)

    @property
    def running(self) -> frozenset[str]:
        return frozenset(program.executable for program, _ in self._running)

    @property
    def now_ns(self) -> int:
        return int(self.node.get_clock().now().nanoseconds)

    @property
    def seconds(self) -> float:
        return time.monotonic() - self._start_time

    def step(self, dt_ns: int) -> None:
        """Take messages for `dt_ns` nanoseconds of real time. If `dt_ns` is not positive, return at once."""
        if dt_ns <= 0:
            return
        end_time = time.monotonic() + dt_ns / 1e9
        pids = (process.innermost() for process in self.processes)
        with cpu_starvation.watch(pids, dt_ns / 1e9, self._workspace.time_record.add_wait):
            while (remaining_seconds := end_time - time.monotonic()) > 0:
                self._are_alive()
                self._grader_node.spin(min(remaining_seconds, 0.05))

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        return self.wait_for(lambda: self._are_alive() and condition(), seconds)

    def rate(self, topic: str, since: float) -> float:
        return usual_rate([received.seconds for received in self.messages(topic, since=since)], self.seconds - since)

    def stop(self, number: signal.Signals, seconds: float) -> int | None:
        """Send a signal. Return the first program's exit status, or None if it is still running after `seconds`."""
        for process in self.processes:
            process.signal(number)
        first = self.processes[0]
        return first.returncode if first.wait(seconds) else None

    def _arrival_seconds(self, arrived_ns: int) -> float:
        # The message may have waited while the grader was busy with another harness.
        return self.seconds - (time.time_ns() - arrived_ns) / 1e9

    def _are_alive(self) -> bool:
        """Drop optional programs that have ended, and return True.

        Raises:
            StudentError: a program that is not optional has ended.
        """
        for program, process in self._running:
            if process.exit_reason is None:
                continue
            if program.executable not in self.optional:
                raise self._error_of(program, StudentError(diagnose_output(process) or diagnose_exit(process)))
            process.kill()
            self._running = [other for other in self._running if other[1] is not process]
        return True

    def _match(self) -> None:
        start = self.seconds
        super()._match()
        self.discovery_seconds = max(self.discovery_seconds, self.seconds - start)
        self.step(GRACE_NS)

    def _topics(self) -> tuple[set[str], set[str]]:
        def is_complete() -> bool:
            return all(map(self._grader_node.subscriptions_of, self._publishes)) and all(
                map(self._grader_node.publishers_of, self._subscribes)
            )

        self.wait_for(lambda: self._are_alive() and is_complete(), SETTLE_SECONDS)
        return {topic for topic in self._publishes if self._grader_node.subscriptions_of(topic)}, {
            topic for topic in self._subscribes if self._grader_node.publishers_of(topic)
        }

    def _connected(self) -> bool:
        # The programs cannot be asked. The grader's endpoints are matched once they see a peer.
        readers = [reader.entity for reader in self._grader_node.readers if reader.kind == "subscription"]
        return all(publisher.get_subscription_count() for publisher in self._grader_node.publishers.values()) and all(
            self.node.count_publishers(reader.topic_name) for reader in readers
        )

    def _wait_for_server(self, client: Any, seconds: float) -> bool:
        return self.until(client.service_is_ready, seconds)


def usual_rate(instants: Sequence[float], seconds: float) -> float:
    """Return the usual rate, per second, of events during `seconds`. `instants` are their times in s, ascending.

    A busy machine sometimes keeps a program from running, and the events that were due then never happen. The number of
    events would blame the program for that, but the median interval does not. The number is used only if it is less
    than half of what the median interval implies.
    """
    count = len(instants) / seconds
    if len(instants) < 3:
        return count
    median_rate = 1.0 / max(statistics.median(after - before for before, after in pairwise(instants)), 1e-6)
    return median_rate if count > median_rate / 2 else count
