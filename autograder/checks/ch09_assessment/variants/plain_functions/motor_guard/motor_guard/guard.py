"""A decision as a state machine of two states, each a function."""

import math
import sys

import rclpy
from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def resting(celsius, hot, cool):
    """Return the state after this temperature, when the fan was off."""
    return resting if celsius < hot else running


def running(celsius, hot, cool):
    """Return the state after this temperature, when the fan was on."""
    return resting if celsius <= cool else running


def main(args=None):
    """Decide until a signal comes."""
    rclpy.init(args=args)
    node = Node("guard")
    hot = node.declare_parameter("hot", 60.0).value
    cool = node.declare_parameter("cool", 50.0).value
    if not cool < hot:
        node.get_logger().fatal("cool must be less than hot")
        sys.exit(2)
    state = resting
    publisher = node.create_publisher(Decision, "decision", 10)

    def decide(average):
        nonlocal state
        known = math.isfinite(average.celsius)
        state = state(average.celsius, hot, cool) if known else state  # what is not known changes no state
        cooling = state is running or not known
        publisher.publish(Decision(stamp=average.stamp, cooling=cooling, celsius=average.celsius))

    node.create_subscription(Temperature, "smoothed", decide, 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
