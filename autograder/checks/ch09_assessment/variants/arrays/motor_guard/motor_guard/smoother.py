"""A moving average over an array with the newest readings."""

from motor_guard_interfaces.msg import Temperature
import numpy as np
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.node import Node
from rclpy.qos import QoSProfile

from motor_guard.running import run


class Smoother(Node):
    """A node that averages an array, whose unused places contain nan."""

    def __init__(self, **kwargs):
        """Create an empty window and the endpoints."""
        super().__init__('smoother', **kwargs)
        limits = ParameterDescriptor(description='readings', read_only=True)
        limits.integer_range.append(IntegerRange(from_value=1, to_value=100, step=1))
        size = self.declare_parameter('window', 5, limits).get_parameter_value().integer_value
        self.window = np.full(size, np.nan)
        self.smoothed = self.create_publisher(Temperature, 'smoothed', QoSProfile(depth=10))
        self.create_subscription(Temperature, 'temperature', self.smooth, QoSProfile(depth=10))

    def smooth(self, reading):
        """Store a finite reading, and publish the mean of the stored ones."""
        if not np.isfinite(reading.celsius):
            return
        self.window = np.roll(self.window, 1)
        self.window[0] = reading.celsius
        answer = Temperature(celsius=float(np.nanmean(self.window)))
        answer.stamp = reading.stamp
        self.smoothed.publish(answer)


def main(args=None):
    """Run the node until it is interrupted."""
    run(Smoother, args)
