"""The events of processes: reports of what happened to one, and requests to shut one down or to signal it."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any, Protocol

from standin_notice import make_getattr

from ..event import Event


class ProcessAction(Protocol):
    """The part of the action of a process that the events use; `launch.actions.ExecuteLocal` is one."""

    @property
    def process_details(self) -> dict[str, Any] | None:
        """The action, name, pid, cmd, cwd and env of the process, or None before it is prepared."""


ProcessMatcher = Callable[[ProcessAction], bool]


class RunningProcessEvent(Event):
    """The base of events that report what happened to a process, with the details of the process."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: ProcessAction,
        name: str,
        cmd: list[str],
        cwd: str | None,
        env: dict[str, str] | None,
        pid: int,
    ) -> None:
        self.action = action
        self.process_name = name
        self.cmd = cmd
        self.cwd = cwd
        self.env = env
        self.pid = pid

    @property
    def execute_process_action(self) -> ProcessAction:
        """The action that runs the process; an older name of `action`."""
        return self.action


class ProcessStarted(RunningProcessEvent):
    """The process has started."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """The process has ended with `returncode`."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **details: Any) -> None:
        super().__init__(**details)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """Bytes that were written to or read from the process."""

    name = "launch.events.process.ProcessIO"
    from_stdin = False
    from_stdout = False
    from_stderr = False

    def __init__(self, *, text: bytes, fd: int = -1, **details: Any) -> None:
        super().__init__(**details)
        self.text = text
        self.fd = fd


class ProcessStdin(ProcessIO):
    """Bytes for the process's standard input."""

    name = "launch.events.process.ProcessStdin"
    from_stdin = True


class ProcessStdout(ProcessIO):
    """Bytes from the process's standard output."""

    name = "launch.events.process.ProcessStdout"
    from_stdout = True


class ProcessStderr(ProcessIO):
    """Bytes from the process's standard error."""

    name = "launch.events.process.ProcessStderr"
    from_stderr = True


class ProcessTargetedEvent(Event):
    """The base of requests for all processes for which `process_matcher` is true."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: ProcessMatcher) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """A request to shut a process down by SIGINT, then SIGTERM, then SIGKILL."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """A request to send a signal, given by number or by name."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | int | signal.Signals, process_matcher: ProcessMatcher) -> None:
        super().__init__(process_matcher=process_matcher)
        self.signal = signal.Signals[signal_number] if isinstance(signal_number, str) else signal.Signals(signal_number)
        self.signal_name = self.signal.name


def matches_pid(pid: int) -> ProcessMatcher:
    """Return a matcher for the process with this process id."""
    return lambda action: (action.process_details or {}).get("pid") == pid


def matches_name(name: str) -> ProcessMatcher:
    """Return a matcher for processes with this name, such as ``talker-1``."""
    return lambda action: (action.process_details or {}).get("name") == name


def matches_executable(executable: str) -> ProcessMatcher:
    """Return a matcher for processes whose command starts with this executable."""
    return lambda action: (action.process_details or {}).get("cmd", [None])[0] == executable


__getattr__ = make_getattr(__name__)
