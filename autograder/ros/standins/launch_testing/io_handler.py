"""The output of the processes of a launch, in the order in which it came."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from typing import Any, cast

from launch.actions import ExecuteLocal
from launch.events.process import ProcessIO
from standin_notice import make_getattr

from .asserts import assertInStream
from .util import NoMatchingProcessException, resolveProcesses

__all__ = ["ActiveIoHandler", "IoHandler"]


class IoHandler:
    """Records the output of processes; iterating over it yields the events of all processes."""

    def __init__(self) -> None:
        self._events: list[ProcessIO] = []
        self._by_name: dict[str, list[ProcessIO]] = {}

    def track(self, process_name: str) -> None:
        """Add a process that has not written anything yet."""
        self._by_name.setdefault(process_name, [])

    def append(self, process_io: ProcessIO) -> None:
        """Add output."""
        self._events.append(process_io)
        self._by_name.setdefault(process_io.process_name, []).append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        return iter(self._events)

    def __getitem__(self, key: ExecuteLocal | str) -> list[ProcessIO]:
        """Return the output of a process, by its name or action; raise KeyError for an unknown process."""
        name = key if isinstance(key, str) else (key.process_details or {})["name"]
        return list(self._by_name[name])

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions of the processes that have written something."""
        return [cast(ExecuteLocal, events[0].action) for events in self._by_name.values() if events]

    def process_names(self) -> Iterable[str]:
        """Return the names of the known processes."""
        return self._by_name.keys()


class ActiveIoHandler:
    """Records the output of running processes, so that tests in another thread can wait for it."""

    def __init__(self) -> None:
        self._io_handler = IoHandler()
        self._changed = threading.Condition()

    @property
    def io_event(self) -> threading.Condition:
        """A condition that is notified of all output."""
        return self._changed

    def track(self, process_name: str) -> None:
        """Add a process that has not written anything yet."""
        with self._changed:
            self._io_handler.track(process_name)
            self._changed.notify_all()

    def append(self, process_io: ProcessIO) -> None:
        """Add output."""
        with self._changed:
            self._io_handler.append(process_io)
            self._changed.notify_all()

    def __iter__(self) -> Iterator[ProcessIO]:
        with self._changed:
            return iter(list(self._io_handler))

    def __getitem__(self, key: ExecuteLocal | str) -> list[ProcessIO]:
        with self._changed:
            return self._io_handler[key]

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions of the processes that have written something."""
        with self._changed:
            return list(self._io_handler.processes())

    def process_names(self) -> list[str]:
        """Return the names of the known processes."""
        with self._changed:
            return list(self._io_handler.process_names())

    def waitFor(
        self,
        expected_output: Any,
        process: ExecuteLocal | str | None = None,
        cmd_args: Any = None,
        *,
        timeout: float = 10,
        strict_proc_matching: bool = True,
        **options: Any,
    ) -> bool:
        """Return whether a text came within `timeout` seconds.

        The other arguments are those of `assertInStream`. Without a process, the output of any process counts.

        Raises:
            Exception: there is no such process after `timeout` seconds.
        """

        def is_found() -> bool:
            try:
                assertInStream(
                    self._io_handler,
                    expected_output,
                    process,
                    cmd_args,
                    strict_proc_matching=strict_proc_matching,
                    **options,
                )
            except (AssertionError, NoMatchingProcessException):  # it may still come
                return False
            return True

        with self._changed:
            if self._changed.wait_for(is_found, timeout):
                return True
        resolveProcesses(self, process=process, cmd_args=cmd_args, strict_proc_matching=False)
        return False

    def assertWaitFor(self, *args: Any, **kwargs: Any) -> None:
        """Fail unless a text came in time; see `waitFor`."""
        assert self.waitFor(*args, **kwargs), "Waiting for output timed out"


__getattr__ = make_getattr(__name__)
