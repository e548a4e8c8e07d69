"""The thermometer: a node that publishes the values of an iterator."""

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from motor_guard.core import temperatures
from motor_guard.running import run


def make_node(**kwargs):
    """Return a new node."""
    node = Node('thermometer', **kwargs)
    seconds = node.declare_parameter('period', 0.5).value
    readings = temperatures(node.declare_parameter('mean', 50.0).value, node.declare_parameter('swing', 20.0).value)
    publisher = node.create_publisher(Temperature, 'temperature', 10)
    node.create_timer(seconds, lambda: publisher.publish(
        Temperature(stamp=node.get_clock().now().to_msg(), celsius=next(readings))))
    return node


def main(args=None):
    """Run the node until it is interrupted."""
    run(make_node, args)
