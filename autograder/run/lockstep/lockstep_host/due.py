"""When a program has something to do although nothing was sent to it, as far as the host can see.

A timer is due, or a wait times out: these instants are known. What else may move a program is not seen to come. Such a
program is due at every instant, so that it runs as often as it would if nothing were known about it.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterable
from typing import Any

from rclpy.action import ActionServer
from rclpy.clock import ClockType
from rclpy.event_handler import EventHandler
from rclpy.exceptions import InvalidHandle

EVERY_INSTANT = 0  # the ROS time that stands for it


def next_due(nodes: Iterable[Any], executors: Iterable[Any], wakes: Iterable[int | None]) -> int | None:
    """Return the ROS time in ns of the next timer or of the first of `wakes`; None if there is neither.

    It is `EVERY_INSTANT` where a coroutine waits for what it does not say, a goal may expire, a guard condition may be
    triggered, a timer has another clock than ROS time, or another process or a signal may set the program going.
    """
    if any(not (task.done() or task.cancelled()) for executor in executors for task, _, _ in list(executor._tasks)):
        return EVERY_INSTANT
    if signal.getitimer(signal.ITIMER_REAL)[0] or _has_children():
        return EVERY_INSTANT
    dues = [wake for wake in wakes if wake is not None]
    for node in nodes:
        has_goals = any(isinstance(waitable, ActionServer) and waitable._goal_handles for waitable in node.waitables)
        if has_goals or any(node.guards):
            return EVERY_INSTANT
        dues += [due for timer in node.timers if (due := _due(timer)) is not None]
    return min(dues, default=None)


def is_seen_coming(waitable: Any) -> bool:
    """Return whether only counted messages and the timers of `next_due` make a waitable ready, and rclpy's own logs."""
    own_event = isinstance(waitable, EventHandler) and waitable.callback.__module__ == EventHandler.__module__
    return own_event or isinstance(waitable, ActionServer)


def _due(timer: Any) -> int | None:
    clock = timer.clock
    if clock.clock_type != ClockType.ROS_TIME or not clock.ros_time_is_active:
        return EVERY_INSTANT
    try:
        left = timer.time_until_next_call()
    except InvalidHandle:
        return None
    return None if left is None else max(EVERY_INSTANT, clock.now().nanoseconds + left)


def _has_children() -> bool:
    try:
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return False
    return True
