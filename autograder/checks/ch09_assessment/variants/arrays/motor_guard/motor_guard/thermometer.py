"""A thermometer with a table of one sine period."""

from motor_guard_interfaces.msg import Temperature
import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node

from motor_guard.running import run

SINE = np.sin(2.0 * np.pi * np.arange(20) / 20)


class Thermometer(Node):
    """A node that publishes the entries of a table in turn."""

    def __init__(self, **kwargs):
        """Compute the table, and create the publisher and the timer."""
        super().__init__('thermometer', **kwargs)
        table = [('period', 0.5), ('mean', 50.0), ('swing', 20.0)]
        period, mean, swing = (parameter.value for parameter in self.declare_parameters('', table))
        self.readings, self.number = mean + swing * SINE, 0
        self.out = self.create_publisher(Temperature, 'temperature', 10)
        self.create_timer(period, self.measure, callback_group=MutuallyExclusiveCallbackGroup())

    def measure(self):
        """Publish the next entry."""
        entry = float(self.readings[self.number % len(self.readings)])
        self.number += 1
        reading = Temperature(celsius=entry)
        reading.stamp = self.get_clock().now().to_msg()
        self.out.publish(reading)


def main(args=None):
    """Run the node until it is interrupted."""
    run(Thermometer, args)
