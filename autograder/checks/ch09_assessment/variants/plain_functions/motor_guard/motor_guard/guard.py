"""A guard as a state machine with two states, each of which is a function."""

import math
import sys

import rclpy
from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


def fan_off(celsius, hot, cool):
    """Return the state after this temperature, if the fan was off."""
    return fan_off if celsius < hot else fan_on


def fan_on(celsius, hot, cool):
    """Return the state after this temperature, if the fan was on."""
    return fan_off if celsius <= cool else fan_on


def main(args=None):
    """Run the node until it is interrupted."""
    rclpy.init(args=args)
    node = Node("guard")
    hot = node.declare_parameter("hot", 60.0).value
    cool = node.declare_parameter("cool", 50.0).value
    if not cool < hot:
        node.get_logger().fatal("cool must be less than hot")
        sys.exit(2)
    state = fan_off
    publisher = node.create_publisher(Decision, "decision", 10)

    def decide(average):
        nonlocal state
        is_known = math.isfinite(average.celsius)
        # Unknown temperatures do not change the state.
        state = state(average.celsius, hot, cool) if is_known else state
        cooling = state is fan_on or not is_known
        publisher.publish(Decision(stamp=average.stamp, cooling=cooling, celsius=average.celsius))

    node.create_subscription(Temperature, "smoothed", decide, 10)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
