"""The timer that goes by ROS time, which a simulator may publish."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterable
from typing import Any

from launch import LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType
from launch.actions import TimerAction


class RosTimer(TimerAction):
    """Executes `actions` once, `period` seconds of ROS time after it was itself executed.

    That is wall time, or the time of ``/clock`` after `SetUseSimTime`.
    """

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        **kwargs: Any,
    ) -> None:
        super().__init__(period=period, actions=actions, **kwargs)

    async def _sleep(self, context: LaunchContext, seconds: float, cancel: asyncio.Future[None]) -> None:
        """Wait for `seconds` of ROS time, or until `cancel` is done."""
        if not _uses_sim_time(context):
            await super()._sleep(context, seconds, cancel)
            return
        loop = asyncio.get_running_loop()
        elapsed = loop.create_future()
        stop = threading.Event()

        def finish() -> None:
            if not elapsed.done():
                elapsed.set_result(None)

        def work() -> None:
            try:
                _watch_clock(seconds, stop)
            finally:
                loop.call_soon_threadsafe(finish)

        thread = threading.Thread(target=work, name="launch_ros timer")
        thread.start()
        try:
            await asyncio.wait([elapsed, cancel], return_when=asyncio.FIRST_COMPLETED)
        finally:
            stop.set()
            await asyncio.wait([elapsed])
            thread.join()


def _uses_sim_time(context: LaunchContext) -> bool:
    return bool(context.get_locals_as_dict().get("use_sim_time", False))


def _watch_clock(seconds: float, stop: threading.Event) -> None:
    """Return when `seconds` of the time on ``/clock`` have passed since its first message, or at `stop`."""
    import rclpy
    from rclpy.duration import Duration
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.parameter import Parameter
    from rclpy.signals import SignalHandlerOptions

    ros = rclpy.Context()
    rclpy.init(context=ros, signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node(
        "launch_ros_timer",
        context=ros,
        parameter_overrides=[Parameter("use_sim_time", value=True)],
        enable_rosout=False,
        start_parameter_services=False,
    )
    executor = SingleThreadedExecutor(context=ros)
    executor.add_node(node)
    start = None
    try:
        while not stop.is_set():
            executor.spin_once(timeout_sec=0.1)
            now = node.get_clock().now()
            if start is None and now.nanoseconds > 0:
                start = now
            if start is not None and now - start >= Duration(seconds=seconds):
                return
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown(context=ros)


ROSTimer = RosTimer  # the older spelling, which Jazzy still has
