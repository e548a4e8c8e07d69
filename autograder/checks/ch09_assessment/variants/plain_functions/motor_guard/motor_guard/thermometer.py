"""A thermometer as functions and a plain node."""

from itertools import count
from math import sin, tau

import rclpy
from motor_guard_interfaces.msg import Temperature
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor


def measure(node):
    """Publish a reading each period."""
    for name, default in (("period", 0.5), ("mean", 50.0), ("swing", 20.0)):
        node.declare_parameter(name, default)
    period, mean, swing = (node.get_parameter(name).value for name in ("period", "mean", "swing"))
    readings = (mean + swing * sin(tau * number / 20) for number in count())
    publisher = node.create_publisher(Temperature, "temperature", 10)

    def publish():
        message = Temperature()
        message.stamp = node.get_clock().now().to_msg()
        message.celsius = next(readings)
        publisher.publish(message)

    node.create_timer(period, publish)


def main():
    """Run the node until it is interrupted."""
    rclpy.init()
    node = rclpy.create_node("thermometer")
    try:
        measure(node)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
