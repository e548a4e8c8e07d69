"""The smoother: a node with a moving average."""

import math

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.node import Node

from motor_guard.core import Average
from motor_guard.running import run


class Smoother(Node):
    """A node that replaces its average with each reading."""

    def __init__(self, **kwargs):
        """Create an empty average and the endpoints."""
        super().__init__('smoother', **kwargs)
        descriptor = ParameterDescriptor(integer_range=[IntegerRange(from_value=1, to_value=100)])
        self.average = Average(self.declare_parameter('window', 5, descriptor).value)
        self.out = self.create_publisher(Temperature, 'smoothed', 10)
        self.create_subscription(Temperature, 'temperature', self.on_reading, 10)

    def on_reading(self, reading):
        """Publish the average after a finite reading."""
        if math.isfinite(reading.celsius):
            self.average = self.average.with_number(reading.celsius)
            reading.celsius = self.average.mean
            self.out.publish(reading)


def main(args=None):
    """Run the node until it is interrupted."""
    run(Smoother, args)
