"""The trusted end of a host's pipes: starts it, steps it, and says in the student's words how it failed."""

from __future__ import annotations

import json
import os
import selectors
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.lockstep import protocol
from autograder.lockstep.exceptions import UnsteppableError
from autograder.lockstep.failures import diagnose_crash, diagnose_deadlock, diagnose_ending, stuck
from autograder.lockstep.protocol import Description, ProtocolError, Reply
from autograder.sandbox import Process
from autograder.sandbox.launcher import launch
from autograder.sandbox.spec import Sandbox

HOST = Path(__file__).with_name("lockstep_host")
START_SECONDS = 60.0  # real time from start to the first wait for work, generous for a machine that is busy
STEP_SECONDS = 30.0  # real time for one step
QUIT_SECONDS = 20.0


class Stepper:
    """One student's program in lockstep; a context manager that leaves no process behind.

    Every method raises `StudentError` when the program crashes, ends, hangs or goes over a limit, and
    `UnsteppableError` when it turns out that it cannot be stepped.
    """

    def __init__(self, spec: Sandbox, executable: Path, *, python: str, arguments: tuple[str, ...] = ()) -> None:
        their_read, our_write = os.pipe()
        our_read, their_write = os.pipe()
        command = [python, str(HOST), str(their_read), str(their_write), str(executable), *arguments]
        try:
            self.process: Process = launch(command, spec, pass_fds=(their_read, their_write))
        finally:
            os.close(their_read)
            os.close(their_write)
        os.set_blocking(our_write, False)  # a program that does not read must not hold up the grader
        self._write_fd = our_write
        self._read_fd = our_read
        self._buffer = bytearray()
        self._selector = selectors.DefaultSelector()
        self._selector.register(our_read, selectors.EVENT_READ)

    def wait_ready(self) -> None:
        """Wait until the program waits for work for the first time."""
        self._expect("ready", START_SECONDS, Kind.NEVER_STARTED)

    def describe(self) -> Description:
        """Ask what the program's nodes look like."""
        self._send({"op": "describe"})
        return protocol.description(self._expect("description", STEP_SECONDS, Kind.STUCK))

    def meet(self, kept: Mapping[str, int], early: Mapping[str, int]) -> None:
        """Tell the program that its endpoints see their peers, and what these had sent before."""
        self._send({"op": "meet", "kept": dict(kept), "early": dict(early)})
        self._expect("met", STEP_SECONDS, Kind.STUCK)

    def step(self, instants: Sequence[int], mail: Mapping[str, int]) -> Reply:
        """Let the program live through instants of ROS time; `mail` is what was sent to it since the last step."""
        self._send({"op": "step", "instants": list(instants), "mail": dict(mail)})
        return protocol.reply(self._expect("done", STEP_SECONDS, Kind.STUCK))

    def quit(self) -> int | None:
        """Interrupt the program as Ctrl-C does; return its exit status, or None if it had to be killed."""
        self._send({"op": "quit"})
        return self.process.returncode if self.process.wait(QUIT_SECONDS) else None

    def __enter__(self) -> Stepper:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.__exit__(kind, error, trace)
        self._selector.close()
        os.close(self._read_fd)
        os.close(self._write_fd)

    def _send(self, order: dict[str, Any]) -> None:
        try:
            os.write(self._write_fd, json.dumps(order).encode() + b"\n")
        except (BrokenPipeError, BlockingIOError):
            raise StudentError(self._ending()) from None

    def _expect(self, event: str, seconds: float, on_timeout: Kind) -> dict[str, Any]:
        deadline = time.monotonic() + seconds
        line = self._read_line(deadline)
        if line is None:
            raise StudentError(stuck(on_timeout, seconds, self.process.output))
        try:
            data = protocol.parse(line)
        except ProtocolError:
            raise StudentError(self._ending()) from None
        if data["event"] == "crash":
            self.process.wait(QUIT_SECONDS)
            raise StudentError(diagnose_crash(protocol.crash(data)))
        if data["event"] == "unsteppable":
            raise UnsteppableError(protocol.reason(data), self.process.output)
        if data["event"] == "deadlock":
            raise StudentError(diagnose_deadlock(protocol.deadlock(data), self.process.output))
        if data["event"] != event:
            raise StudentError(self._ending())
        return data

    def _read_line(self, deadline: float) -> bytes | None:
        """Return one line, b'' at the end of the stream, or None at the deadline."""
        while b"\n" not in self._buffer:
            if len(self._buffer) > protocol.MAX_LINE:
                return bytes(self._buffer)
            if not self._selector.select(max(0.0, deadline - time.monotonic())):
                return None
            chunk = os.read(self._read_fd, 65536)
            if not chunk:
                return b""
            self._buffer += chunk
        line, _, rest = bytes(self._buffer).partition(b"\n")
        self._buffer = bytearray(rest)
        return line + b"\n"

    def _ending(self) -> Diagnosis:
        self.process.wait(2.0)
        return diagnose_ending(self.process)
