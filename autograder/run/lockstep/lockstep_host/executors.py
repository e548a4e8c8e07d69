"""Executors that replace rclpy's own in lockstep."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.executors import (
    ConditionReachedException,
    Executor,
    ExternalShutdownException,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
    TimeoutObject,
)

from .callback_threads import CallbackThreads


class CallbackThreadsExecutor(SingleThreadedExecutor):
    """Replaces MultiThreadedExecutor. Callbacks can wait for each other, but only one runs at a time."""

    def __init__(self, num_threads: int | None = None, *, context: Any = None) -> None:
        super().__init__(context=context)
        self.threads = CallbackThreads(num_threads)

    def _spin_once_impl(
        self, timeout_sec: float | TimeoutObject | None = None, wait_condition: Callable[[], bool] = lambda: False
    ) -> None:
        try:
            handler, _, _ = self.wait_for_ready_callbacks(timeout_sec, None, wait_condition)
        except (ShutdownException, ExternalShutdownException, TimeoutException, ConditionReachedException):
            return
        self.threads.start(handler)


def spin_until_future_complete(
    executor: Executor, future: Any, timeout_sec: float | None, ros_time: Callable[[], int]
) -> None:
    """Spin until a future completes, like rclpy's function of this name, but with a time-out in ROS time."""
    future.add_done_callback(lambda _: executor.wake())
    end = None if timeout_sec is None or timeout_sec < 0 else ros_time() + round(timeout_sec * 1e9)
    remaining = None if end is None else TimeoutObject(timeout_sec or 0.0)
    while executor.context.ok() and not future.done() and not future.cancelled() and not executor._is_shutdown:
        executor.spin_once_until_future_complete(future, remaining)
        if remaining is not None and end is not None:
            if ros_time() >= end:
                return
            remaining.timeout = (end - ros_time()) / 1e9
