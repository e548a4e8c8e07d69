"""The thermometer: an iterator in a node."""

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from motor_guard.core import turns
from motor_guard.running import run


def make(**kwargs):
    """Return the node."""
    node = Node('thermometer', **kwargs)
    seconds = node.declare_parameter('period', 0.5).value
    readings = turns(node.declare_parameter('mean', 50.0).value, node.declare_parameter('swing', 20.0).value)
    publisher = node.create_publisher(Temperature, 'temperature', 10)
    node.create_timer(seconds, lambda: publisher.publish(
        Temperature(stamp=node.get_clock().now().to_msg(), celsius=next(readings))))
    return node


def main(args=None):
    """Run it."""
    run(make, args)
