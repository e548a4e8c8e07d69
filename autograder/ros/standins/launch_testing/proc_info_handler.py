"""The starts and exits of the processes of a launch."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any, cast

from launch.actions import ExecuteLocal
from launch.events.process import ProcessExited, RunningProcessEvent
from standin_notice import make_getattr

from .util import NoMatchingProcessException, resolveProcesses

__all__ = ["ActiveProcInfoHandler", "ProcInfoHandler"]


class ProcInfoHandler:
    """Records the newest event, ProcessStarted or ProcessExited, of each process; iterating over it yields these."""

    def __init__(self) -> None:
        self._events: dict[ExecuteLocal, RunningProcessEvent] = {}

    def append(self, process_info: RunningProcessEvent) -> None:
        """Add an event."""
        self._events[cast(ExecuteLocal, process_info.action)] = process_info

    def __iter__(self) -> Iterator[RunningProcessEvent]:
        return iter(self._events.values())

    def __getitem__(self, key: ExecuteLocal | str) -> RunningProcessEvent:
        """Return the newest event of a process, by its action or a part of its name; raise KeyError without one."""
        if not isinstance(key, str):
            return self._events[key]
        for event in self._events.values():
            if key in event.process_name:
                return event
        raise KeyError(key)

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions of the processes."""
        return list(self._events)

    def process_names(self) -> list[str]:
        """Return the names of the processes."""
        return [event.process_name for event in self._events.values()]


class ActiveProcInfoHandler:
    """Records the events of running processes, so that tests in another thread can wait for them."""

    def __init__(self) -> None:
        self._proc_info_handler = ProcInfoHandler()
        self._changed = threading.Condition()

    @property
    def proc_event(self) -> threading.Condition:
        """A condition that is notified of all events."""
        return self._changed

    def append(self, process_info: RunningProcessEvent) -> None:
        """Add an event."""
        with self._changed:
            self._proc_info_handler.append(process_info)
            self._changed.notify_all()

    def __iter__(self) -> Iterator[RunningProcessEvent]:
        with self._changed:
            return iter(list(self._proc_info_handler))

    def __getitem__(self, key: ExecuteLocal | str) -> RunningProcessEvent:
        with self._changed:
            return self._proc_info_handler[key]

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions of the processes."""
        with self._changed:
            return self._proc_info_handler.processes()

    def process_names(self) -> list[str]:
        """Return the names of the processes."""
        with self._changed:
            return self._proc_info_handler.process_names()

    def assertWaitForShutdown(self, process: ExecuteLocal | str, cmd_args: Any = None, *, timeout: float = 10) -> None:
        """Fail unless the process ends within `timeout` seconds."""
        happened = self._wait(process, cmd_args, timeout, lambda event: isinstance(event, ProcessExited))
        assert happened, f"Timed out waiting for process '{process}' to finish"

    def assertWaitForStartup(self, process: ExecuteLocal | str, cmd_args: Any = None, *, timeout: float = 10) -> None:
        """Fail unless the process starts within `timeout` seconds."""
        happened = self._wait(process, cmd_args, timeout, lambda event: True)
        assert happened, f"Timed out waiting for process '{process}' to start"

    def _wait(
        self, process: Any, cmd_args: Any, timeout: float, is_expected: Callable[[RunningProcessEvent], bool]
    ) -> bool:
        handler = self._proc_info_handler

        def happened() -> bool:
            try:
                actions = resolveProcesses(handler, process=process, cmd_args=cmd_args)
            except NoMatchingProcessException:
                return False
            return is_expected(handler[actions[0]])

        with self._changed:
            return self._changed.wait_for(happened, timeout)


__getattr__ = make_getattr(__name__)
