"""The trusted end of a host's pipes: it starts the host, steps it, and tells the student how the program failed."""

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
QUIT_SECONDS = 20.0
HARMLESS_SECONDS = 1.0  # for which a program may keep the grader waiting, whatever the reason
_TICK = 0.5  # s between two looks at how much a silent program has computed


@dataclass(frozen=True)
class Timeout:
    """How long a program may take for an answer: real time, and processor time, which finds an endless loop."""

    seconds: float  # generous for a machine that is busy
    cpu_seconds: float


# From the start to the first wait for work, which takes half a second of processor time.
START_TIMEOUT = Timeout(60.0, 15.0)
STEP_TIMEOUT = Timeout(30.0, 10.0)


class UnsteppableError(StudentError):
    """A program's time cannot be stepped; it has to run in real time. `reason` is one of the protocol's `REASONS`."""

    def __init__(self, reason: str, output: str) -> None:
        super().__init__(diagnose_unsteppable(reason, output))
        self.reason = reason


class Stepper:
    """One student's program in lockstep; a context manager that leaves no process behind.

    Every method raises `StudentError` when the program crashes, ends, hangs or goes over a limit, and
    `UnsteppableError` when it turns out that it cannot be stepped.

    Args:
        spec: the sandbox, which shows the program and the host.
        executable: the program's path.
        arguments: the program's.
        clock_rate: seconds that the clocks of its machine count in a second of ROS time.
    """

    def __init__(
        self, spec: Sandbox, executable: Path, arguments: tuple[str, ...] = (), clock_rate: float = 1.0
    ) -> None:
        self._at_start = starvation.measure_use(())
        their_read, our_write = os.pipe()
        our_read, their_write = os.pipe()
        words = (HOST, their_read, their_write, START_NS, clock_rate, executable)
        command = [sys.executable, *map(str, words), *arguments]
        try:
            self.process: Process = launch(command, spec, pass_fds=(their_read, their_write), profile="lockstep")
        finally:
            os.close(their_read)
            os.close(their_write)
        os.set_blocking(our_write, False)  # a program that does not read must not hold up the grader
        self._write_fd = our_write
        self._read_fd = our_read
        self._buffer = bytearray()
        self._held = 0.0  # s for which it kept the grader waiting
        self._excused = 0.0  # those of them in which the machine did not let it run, as far as looked at
        self._selector = selectors.DefaultSelector()
        self._selector.register(our_read, selectors.EVENT_READ)

    def wait_ready(self) -> None:
        """Wait until the program waits for work for the first time."""
        self._expect("ready", START_TIMEOUT, Kind.NEVER_STARTED)

    def describe(self) -> Description:
        """Ask what the program's nodes look like."""
        self._send({"op": "describe"})
        description: Description = self._expect("description", STEP_TIMEOUT, Kind.STUCK)
        return description

    def match(self, kept: Mapping[str, int], early: Mapping[str, int]) -> None:
        """Tell the program that its endpoints are matched, and what others sent before, by channel.

        Args:
            kept: messages that transient-local publishers hold.
            early: requests and responses.
        """
        self._send({"op": "match", "kept": dict(kept), "early": dict(early)})
        self._expect("matched", STEP_TIMEOUT, Kind.STUCK)

    def step(self, events: Sequence[Event]) -> Reply:
        """Run the program for events, at least one, in the order of their instants, or for the first of them."""
        self._send({"op": "step", "events": events})
        reply: Reply = self._expect("done", STEP_TIMEOUT, Kind.STUCK)
        if not 0 < len(reply.sent) <= len(events):
            raise StudentError(self._exit_reason())
        return reply

    def __enter__(self) -> Stepper:
        return self

    def __exit__(self, *_: object) -> None:
        if self._held > HARMLESS_SECONDS:
            self._excuse()
        self.process.__exit__()
        self._selector.close()
        os.close(self._read_fd)
        os.close(self._write_fd)

    def _send(self, command: dict[str, Any]) -> None:
        try:
            os.write(self._write_fd, json.dumps(command).encode() + b"\n")
        except (BrokenPipeError, BlockingIOError):
            raise StudentError(self._exit_reason()) from None

    def _expect(self, wanted: str, timeout: Timeout, on_timeout: Kind) -> Any:
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
        if event != wanted:
            raise StudentError(self._exit_reason())
        return record

    def _read_line(self, timeout: Timeout, on_timeout: Kind) -> bytes:
        """Return one line, or b'' at the end of the stream."""
        began, before = time.monotonic(), None
        deadline = began + patience.bounded(timeout.seconds)
        while b"\n" not in self._buffer:
            if len(self._buffer) > protocol.MAX_LINE:
                raise StudentError(diagnose_too_much(self.process.output))
            left = deadline - time.monotonic()
            if not self._selector.select(max(0.0, min(_TICK, left))):
                if left <= 0.0:
                    raise self._no_answer(on_timeout, f"{timeout.seconds:.0f} s")
                now = self.process.cpu_seconds()
                before = now if before is None else before
                if now - before > timeout.cpu_seconds:
                    raise self._no_answer(on_timeout, f"{timeout.cpu_seconds:.0f} s of computing")
                self._require_patience(time.monotonic() - began)
                continue
            chunk = os.read(self._read_fd, 65536)
            if not chunk:
                return b""
            self._buffer += chunk
        waited = time.monotonic() - began
        self._held += waited
        patience.add_answer_time(waited)
        self._require_patience()
        line, _, rest = bytes(self._buffer).partition(b"\n")
        self._buffer = bytearray(rest)
        return line + b"\n"

    def _require_patience(self, waiting: float = 0.0) -> None:
        """Raise a StudentError if programs have held the grading for too long, this one for `waiting` just now."""
        if patience.is_too_slow(waiting):
            self._excuse()
            if patience.is_too_slow(waiting):
                raise patience.too_slow_error()

    def _excuse(self) -> None:
        """Take back the time for which the program was ready to answer, and others did not let it run."""
        waited = starvation.starved_seconds(self._at_start, starvation.measure_use((self.process.innermost(),)))
        excused = min(max(0.0, waited), self._held)
        patience.add_answer_time(self._excused - excused)
        self._excused = excused

    def _no_answer(self, kind: Kind, waited: str) -> StudentError:
        return StudentError(diagnose_no_answer(kind, waited, self.process.output))

    def _exit_reason(self) -> Diagnosis:
        self.process.wait(2.0)
        return diagnose_exit(self.process)
