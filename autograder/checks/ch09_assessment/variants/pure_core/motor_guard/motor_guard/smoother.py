"""The smoother: an average in a node."""

import math

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.node import Node

from motor_guard.core import Average
from motor_guard.running import run


class Smoother(Node):
    """Holds the average of now."""

    def __init__(self, **kwargs):
        """Begin with nothing."""
        super().__init__('smoother', **kwargs)
        descriptor = ParameterDescriptor(integer_range=[IntegerRange(from_value=1, to_value=100)])
        self.average = Average(self.declare_parameter('window', 5, descriptor).value)
        self.out = self.create_publisher(Temperature, 'smoothed', 10)
        self.create_subscription(Temperature, 'temperature', self.hear, 10)

    def hear(self, reading):
        """Take numbers only."""
        if math.isfinite(reading.celsius):
            self.average = self.average.after(reading.celsius)
            reading.celsius = self.average.mean
            self.out.publish(reading)


def main(args=None):
    """Run it."""
    run(Smoother, args)
