"""The trusted side of a host's pipes. It starts and steps the host, and explains failures of the program."""

from __future__ import annotations

import json
import os
import selectors
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run import patience
from autograder.run.lockstep import protocol
from autograder.run.lockstep.failures import (
    diagnose_crash,
    diagnose_deadlock,
    diagnose_exit,
    diagnose_no_answer,
    diagnose_too_much,
    diagnose_unsteppable,
)
from autograder.run.lockstep.protocol import START_NS, Description, Event, ProtocolError, Reply
from autograder.run.sandbox import Process, starvation
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.spec import Sandbox

HOST = Path(__file__).with_name("lockstep_host")
QUIT_SECONDS = 20.0  # maximum real time until a program that has reported its crash has ended
HARMLESS_SECONDS = 1.0  # if all waits for a program take at most this long, their cause is not analysed
_TICK = 0.5  # s between two measurements of the processor time of a program that does not answer


@dataclass(frozen=True)
class Timeout:
    """The time limits for an answer: in real time, and in processor time, which detects endless loops."""

    seconds: float  # long enough for a busy machine
    cpu_seconds: float


# For the time from a program's start to its first wait for work, which usually takes 0.5 s of processor time.
START_TIMEOUT = Timeout(60.0, 15.0)
STEP_TIMEOUT = Timeout(30.0, 10.0)


class UnsteppableError(StudentError):
    """A program's time cannot be stepped; it has to run in real time. `reason` is one of the protocol's `REASONS`."""

    def __init__(self, reason: str, output: str) -> None:
        super().__init__(diagnose_unsteppable(reason, output))
        self.reason = reason


class Stepper:
    """One student's program in lockstep; a context manager that leaves no process behind.

    Every method raises `StudentError` when the program crashes, ends, hangs or exceeds a limit, and
    `UnsteppableError` when it cannot be stepped.

    Args:
        spec: the sandbox, in which the program and the host are visible.
        executable: the program's path.
        arguments: the program's arguments.
        clock_rate: how many seconds the program's system clocks advance per second of ROS time.
    """

    def __init__(
        self, spec: Sandbox, executable: Path, arguments: tuple[str, ...] = (), clock_rate: float = 1.0
    ) -> None:
        self._use_at_start = starvation.measure_use(())
        host_read, write_fd = os.pipe()
        read_fd, host_write = os.pipe()
        words = (HOST, host_read, host_write, START_NS, clock_rate, executable)
        command = [sys.executable, *map(str, words), *arguments]
        try:
            self.process: Process = launch(command, spec, pass_fds=(host_read, host_write), profile="lockstep")
        finally:
            os.close(host_read)
            os.close(host_write)
        for descriptor in (read_fd, write_fd):  # a program must not block the grader
            os.set_blocking(descriptor, False)
        self._write_fd = write_fd
        self._read_fd = read_fd
        self._buffer = bytearray()
        self._waited_seconds = 0.0  # real time for which the grader has waited for the program's answers
        self._starved_seconds = 0.0  # the part of it in which other processes kept the program from running
        self._selector = selectors.DefaultSelector()
        self._selector.register(read_fd, selectors.EVENT_READ)

    def wait_ready(self) -> None:
        """Wait until the program first waits for work."""
        self._expect("ready", START_TIMEOUT, Kind.NEVER_STARTED)

    def describe(self) -> Description:
        """Request a description of the program's nodes."""
        self._send({"op": "describe"})
        description: Description = self._expect("description", STEP_TIMEOUT, Kind.STUCK)
        return description

    def match(self, kept: Mapping[str, int], early: Mapping[str, int]) -> None:
        """Tell the program that its endpoints are matched, and how many messages others have sent, by channel.

        Args:
            kept: messages that transient-local publishers keep.
            early: requests and responses.
        """
        self._send({"op": "match", "kept": dict(kept), "early": dict(early)})
        self._expect("matched", STEP_TIMEOUT, Kind.STUCK)

    def step(self, events: Sequence[Event]) -> Reply:
        """Run the program for events in the order of their instants. The reply may cover only the first of them."""
        self._send({"op": "step", "events": events})
        reply: Reply = self._expect("done", STEP_TIMEOUT, Kind.STUCK)
        if not 0 < len(reply.sent) <= len(events):
            raise StudentError(self._exit_reason())
        return reply

    def __enter__(self) -> Stepper:
        return self

    def __exit__(self, *_: object) -> None:
        if self._waited_seconds > HARMLESS_SECONDS:
            self._deduct_starvation()
        self.process.__exit__()
        self._selector.close()
        os.close(self._read_fd)
        os.close(self._write_fd)

    def _send(self, command: dict[str, Any]) -> None:
        try:
            os.write(self._write_fd, json.dumps(command).encode() + b"\n")
        except (BrokenPipeError, BlockingIOError):
            raise StudentError(self._exit_reason()) from None

    def _expect(self, expected_event: str, timeout: Timeout, on_timeout: Kind) -> Any:
        try:
            event, record = protocol.parse(self._read_line(timeout, on_timeout))
        except ProtocolError:
            raise StudentError(self._exit_reason()) from None
        if event == "crash":
            self.process.wait(QUIT_SECONDS)
            raise StudentError(diagnose_crash(record))
        if event == "unsteppable":
            raise UnsteppableError(record, self.process.output)
        if event == "deadlock":
            raise StudentError(diagnose_deadlock(record, self.process.output))
        if event != expected_event:
            raise StudentError(self._exit_reason())
        return record

    def _read_line(self, timeout: Timeout, on_timeout: Kind) -> bytes:
        """Return one line, or b'' at the end of the stream.

        The limits also hold while bytes arrive, because the student's code can write to the pipe, too.
        """
        start, first_cpu_seconds = time.monotonic(), None
        deadline, next_check = start + patience.bounded(timeout.seconds), start + _TICK
        while b"\n" not in self._buffer:
            if len(self._buffer) > protocol.MAX_LINE:
                raise StudentError(diagnose_too_much(self.process.output))
            remaining_seconds = min(deadline, next_check) - time.monotonic()
            if self._selector.select(max(0.0, remaining_seconds)) and not self._fill_buffer():
                return b""
            now = time.monotonic()
            if b"\n" in self._buffer or now < min(deadline, next_check):
                continue
            if now >= deadline:
                raise self._no_answer(on_timeout, f"{timeout.seconds:.0f} s")
            next_check = now + _TICK
            cpu_seconds = self.process.cpu_seconds()
            first_cpu_seconds = cpu_seconds if first_cpu_seconds is None else first_cpu_seconds
            if cpu_seconds - first_cpu_seconds > timeout.cpu_seconds:
                raise self._no_answer(on_timeout, f"{timeout.cpu_seconds:.0f} s of computing")
            self._require_patience(now - start)
        elapsed_seconds = time.monotonic() - start
        self._waited_seconds += elapsed_seconds
        patience.add_answer_time(elapsed_seconds)
        self._require_patience()
        line, _, next_lines = bytes(self._buffer).partition(b"\n")
        self._buffer = bytearray(next_lines)
        return line + b"\n"

    def _fill_buffer(self) -> bool:
        """Read the available bytes. Return whether more may follow."""
        try:
            chunk = os.read(self._read_fd, 65536)
        except BlockingIOError:  # the student's code has opened the pipe, too, and was faster
            return True
        self._buffer += chunk
        return bool(chunk)

    def _require_patience(self, waiting_seconds: float = 0.0) -> None:
        """Raise a StudentError if all answers, and the current one after `waiting_seconds`, have taken too long."""
        if patience.is_too_slow(waiting_seconds):
            self._deduct_starvation()
            if patience.is_too_slow(waiting_seconds):
                raise patience.too_slow_error()

    def _deduct_starvation(self) -> None:
        """Deduct the time for which the program was ready to run, but other processes used the processor."""
        starved = starvation.starved_seconds(self._use_at_start, starvation.measure_use((self.process.innermost(),)))
        starved_seconds = min(max(0.0, starved), self._waited_seconds)
        patience.add_answer_time(self._starved_seconds - starved_seconds)
        self._starved_seconds = starved_seconds

    def _no_answer(self, kind: Kind, duration: str) -> StudentError:
        return StudentError(diagnose_no_answer(kind, duration, self.process.output))

    def _exit_reason(self) -> Diagnosis:
        self.process.wait(2.0)
        return diagnose_exit(self.process)
