"""The node through which a launch itself takes part in ROS.

rclpy is imported when it is needed: a launched program that is a fork must not find parts of it imported.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from typing import Any

from launch import LaunchContext
from launch.event_handlers import OnShutdown
from standin_notice import guard

__all__ = ["ROSAdapter", "get_ros_adapter", "get_ros_node"]

__getattr__ = guard(__name__)


class ROSAdapter:
    """A node of a launch, named ``launch_ros_<pid>``, and the thread that spins it.

    `argv` are arguments for `rclpy.init`. Without `autostart`, the caller starts it.
    """

    def __init__(self, *, argv: Sequence[str] | None = None, autostart: bool = True) -> None:
        self.argv = list(argv or ())
        self.ros_context: Any = None
        self.ros_node: Any = None
        self.ros_executor: Any = None
        self._thread: threading.Thread | None = None
        if autostart:
            self.start()

    def start(self) -> None:
        """Create the node and begin to spin it; RuntimeError if it is already there."""
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        if self._thread is not None:
            raise RuntimeError("Cannot start a ROS adapter that is already running")
        self.ros_context = rclpy.Context()
        rclpy.init(args=self.argv, context=self.ros_context)
        self.ros_node = rclpy.create_node(f"launch_ros_{os.getpid()}", context=self.ros_context)
        self.ros_executor = SingleThreadedExecutor(context=self.ros_context)
        self.ros_executor.add_node(self.ros_node)
        self._thread = threading.Thread(target=self._spin, args=(self.ros_executor,), name="launch_ros node")
        self._thread.start()

    @staticmethod
    def _spin(executor: Any) -> None:
        from rclpy.executors import ExternalShutdownException

        try:
            executor.spin()
        except ExternalShutdownException:
            return  # SIGINT ends all contexts of the process

    def shutdown(self) -> None:
        """Stop to spin and destroy the node; RuntimeError if it is not there."""
        if self._thread is None or self.ros_executor is None:
            raise RuntimeError("Cannot shutdown a ROS adapter that is not running")
        self.ros_executor.shutdown()
        self._thread.join()
        self._thread = None
        self.ros_node.destroy_node()
        self.ros_context.try_shutdown()


def get_ros_adapter(context: LaunchContext) -> ROSAdapter:
    """Return the adapter of a launch, which is started when it is first asked for and ends with the launch."""
    found: ROSAdapter | None = context.get_locals_as_dict().get("ros_adapter")
    if found is not None:
        return found
    adapter = ROSAdapter()
    context.extend_globals({"ros_adapter": adapter})
    context.register_event_handler(OnShutdown(on_shutdown=lambda event, context: adapter.shutdown()))
    return adapter


def get_ros_node(context: LaunchContext) -> Any:
    """Return the node of a launch, as `get_ros_adapter` does."""
    return get_ros_adapter(context).ros_node
