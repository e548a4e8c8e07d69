"""A moving average with a list, in a node that checks its parameter itself."""

import math

import rclpy
from motor_guard_interfaces.msg import Temperature
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class MovingAverage(Node):
    """A node that averages the newest readings."""

    def __init__(self):
        """Read the parameter, and refuse a value outside its range."""
        super().__init__("smoother")
        self._size = self.declare_parameter("window", 5).get_parameter_value().integer_value
        if self._size not in range(1, 101):
            raise ValueError("window must be from 1 to 100")
        self._newest = []
        self._publisher = self.create_publisher(Temperature, "smoothed", 10)
        self._subscription = self.create_subscription(
            Temperature, "temperature", self._on_reading, 10, callback_group=ReentrantCallbackGroup()
        )

    def _on_reading(self, message):
        if math.isnan(message.celsius) or math.isinf(message.celsius):
            return
        self._newest = [*self._newest, message.celsius][-self._size :]
        message.celsius = math.fsum(self._newest) / len(self._newest)
        self._publisher.publish(message)


def main():
    """Run the node with two threads."""
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
