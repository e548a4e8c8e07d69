"""The moving average in a class that contains a node."""
from collections import deque
from math import fsum, isfinite

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Average:
    def __init__(self, window):
        self.values = deque((), window)

    def __call__(self, value):
        self.values.append(value)
        return fsum(self.values) / len(self.values)


class Smoother:
    """A node and its moving average."""

    def __init__(self):
        self.node = Node('smoother')
        window = self.node.declare_parameter('window', 5, ParameterDescriptor(
            description='readings in an average', read_only=True,
            integer_range=[IntegerRange(from_value=1, to_value=100, step=1)]))
        self.average = Average(window.value)
        self.out = self.node.create_publisher(Temperature, 'smoothed', 10)
        self.node.create_subscription(
            Temperature, 'temperature', self.smooth, 10,
            callback_group=MutuallyExclusiveCallbackGroup())

    def smooth(self, reading):
        if isfinite(reading.celsius):
            self.out.publish(
                Temperature(stamp=reading.stamp, celsius=self.average(reading.celsius)))


def main(args=None):
    rclpy.init(args=args)
    try:
        smoother = Smoother()
        executor = MultiThreadedExecutor()
        executor.add_node(smoother.node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
