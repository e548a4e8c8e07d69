"""Computes when a program has something to do although nothing was sent to it.

The times of timers and time-outs are known. Other events that may make a program run cannot be predicted. If they are
possible, the program is due at every instant, and so it is run in every step.
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

EVERY_INSTANT = 0  # means "at every instant" where a ROS time is expected


def next_due(nodes: Iterable[Any], executors: Iterable[Any], wakes: Iterable[int | None]) -> int | None:
    """Return the ROS time in ns of the next timer or of the first of `wakes`, or None if neither exists.

    It is `EVERY_INSTANT` if a coroutine waits for an unknown event, a goal may expire, a guard condition may be
    triggered, a timer does not use ROS time, or another process or a signal may make the program run.
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


def is_predictable(waitable: Any) -> bool:
    """Return whether only counted messages, timers of `next_due` and rclpy's own logs can make a waitable ready."""
    is_own_event = isinstance(waitable, EventHandler) and waitable.callback.__module__ == EventHandler.__module__
    return is_own_event or isinstance(waitable, ActionServer)


def _due(timer: Any) -> int | None:
    clock = timer.clock
    if clock.clock_type != ClockType.ROS_TIME or not clock.ros_time_is_active:
        return EVERY_INSTANT
    try:
        remaining_ns = timer.time_until_next_call()
    except InvalidHandle:
        return None
    return None if remaining_ns is None else max(EVERY_INSTANT, clock.now().nanoseconds + remaining_ns)


def _has_children() -> bool:
    try:
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return False
    return True
