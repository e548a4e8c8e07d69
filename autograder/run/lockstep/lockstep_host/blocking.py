"""Makes blocking calls wait in ROS time, and reports a deadlock if a call would never return.

`time.sleep` and `threading.Event.wait` are replaced. rclpy's own blocking calls use the latter: `client.call()`,
`rate.sleep()`, `action_client.send_goal()`. In a single-threaded executor, a wait without a time-out is a deadlock,
because no other callback can run meanwhile.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any

from rclpy.action import ActionClient
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.timer import Rate

from .callback_threads import Worker
from .tasks import awaited_future

# A program that sleeps this often and this long between its first message and its first spin has a loop and never
# spins. A program that has not sent anything yet may only be slow to start.
LOOP_SLEEPS, LOOP_SLEEP_NS = 5, 10**9
MAX_START_SLEEP_NS = 20 * 10**9  # a program that sleeps this long in all before its first spin never spins, either
_wait_for_event = threading.Event.wait


class Blocking:
    """The blocking calls of one `Host`'s program."""

    def __init__(self, host: Any) -> None:
        self._host = host
        self._slept_ns = self._loop_slept_ns = self._loop_sleeps = 0

    def install(self) -> None:
        """Replace `threading.Event.wait` for all callers except Python's own library."""

        def wait(event: threading.Event, timeout: float | None = None) -> bool:
            caller = sys._getframe(1)
            module = str(caller.f_globals.get("__name__")).partition(".")[0]
            if event.is_set() or module in sys.stdlib_module_names - {"__main__"} or not self._host.is_stepped_thread():
                return _wait_for_event(event, timeout)
            return self._wait(event, timeout, caller)

        threading.Event.wait = wait  # type: ignore[assignment, method-assign]

    def sleep(self, nanoseconds: int) -> bool:
        """Let ROS time pass. Return False if the machine's time has to pass instead."""
        host = self._host
        if not host.is_stepped_thread():
            return False
        if host.phase == "spin":
            end = host.time + nanoseconds
            self._wait_until(lambda: bool(host.time >= end), end)
            return True
        if host.nodes():
            self._slept_ns += nanoseconds
            if host.has_sent():
                self._loop_slept_ns, self._loop_sleeps = self._loop_slept_ns + nanoseconds, self._loop_sleeps + 1
            if (
                self._loop_sleeps >= LOOP_SLEEPS and self._loop_slept_ns >= LOOP_SLEEP_NS
            ) or self._slept_ns >= MAX_START_SLEEP_NS:
                host.stop(event="unsteppable", reason="sleep")
        return False

    def check(self, executor: Executor, end: int | None) -> None:
        """Report a callback that never returns, because its callback group blocks the callback for which it waits.

        `executor` has found nothing to do. `end` is the ROS time in ns at which its wait times out, None for never.
        """
        for reader in self._host.counts.unread_readers:
            client = reader.entity
            if not isinstance(client, Client) or executor.can_execute(client):
                continue
            pending = [id(future) for future in client._pending_requests.values()]
            if end is None and any(task.executing() for task, _, _ in executor._tasks):
                call = "spin_until_future_complete()"
            elif any(id(awaited_future(task)) in pending for task, _, _ in executor._tasks):
                call = "await client.call_async()"
            else:
                continue
            self._host.stop(event="deadlock", what=call, name=client.service_name, reason="group")

    def _wait(self, event: threading.Event, timeout: float | None, caller: Any) -> bool:
        host = self._host
        if timeout is None:
            self._expect_deadlock(caller)
        elif host.phase != "spin":
            return _wait_for_event(event, timeout)
        end = None if timeout is None else host.time + round(timeout * 1e9)
        self._wait_until(lambda: event.is_set() or (end is not None and host.time >= end), end)
        return event.is_set()

    def _wait_until(self, ready: Callable[[], bool], end: int | None) -> None:
        thread = threading.current_thread()
        self._host.wakes.append(end)
        try:
            if isinstance(thread, Worker):
                thread.wait(ready)
            else:
                while not ready():
                    self._host.pass_time()
        finally:
            self._host.wakes.remove(end)

    def _expect_deadlock(self, caller: Any) -> None:
        """Report a deadlock if no other thread can end the wait."""
        call, name, entity = _waiting_call(caller)
        if isinstance(threading.current_thread(), Worker):
            if entity is not None and not entity.callback_group.can_execute(entity):
                self._host.stop(event="deadlock", what=call, name=name, reason="group")
        elif not any(thread is not threading.current_thread() for thread in threading.enumerate()):
            reason = "thread" if self._host.phase == "spin" else "spin"
            self._host.stop(event="deadlock", what=call, name=name, reason=reason)


def _waiting_call(caller: Any) -> tuple[str, str, Any]:
    """Return the waiting call, the name of its service or action, and the entity whose callback would end the wait."""
    owner = caller.f_locals.get("self")
    if isinstance(owner, Client):
        return "client.call()", owner.service_name, owner
    if isinstance(owner, ActionClient):
        return "send_goal()", owner._action_name, owner
    if isinstance(owner, Rate):
        return "rate.sleep()", "", owner._timer
    return "wait()", "", None
