"""A moving average with a list, in a node that knows its limits by a callback."""

import math

import rclpy
from motor_guard_interfaces.msg import Temperature
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class MovingAverage(Node):
    """Averages what it hears."""

    def __init__(self):
        """Read the parameter, and refuse one that makes no sense."""
        super().__init__("smoother")
        self._size = self.declare_parameter("window", 5).get_parameter_value().integer_value
        if self._size not in range(1, 101):
            raise ValueError("window must be from 1 to 100")
        self._seen = []
        self._out = self.create_publisher(Temperature, "smoothed", 10)
        self._in = self.create_subscription(
            Temperature, "temperature", self._hear, 10, callback_group=ReentrantCallbackGroup()
        )

    def _hear(self, message):
        if math.isnan(message.celsius) or math.isinf(message.celsius):
            return
        self._seen = [*self._seen, message.celsius][-self._size :]
        message.celsius = math.fsum(self._seen) / len(self._seen)
        self._out.publish(message)


def main():
    """Spin with two threads."""
    rclpy.init()
    node = MovingAverage()
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
