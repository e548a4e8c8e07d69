"""Node smoother: the mean of the newest readings."""

from math import isfinite
from statistics import fmean

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from motor_guard.running import run


class Smoother(Node):
    """Hears temperature, publishes on smoothed."""

    def __init__(self, **kwargs) -> None:
        """Set the node up; kwargs are those of Node."""
        super().__init__('smoother', **kwargs)
        self.window = self.declare_parameter('window', 5).value
        if self.window < 1 or self.window > 100:
            raise ValueError(f'window is {self.window}, it must be from 1 to 100')
        self.readings = []
        self.publisher = self.create_publisher(Temperature, 'smoothed', 10)
        self.subscription = self.create_subscription(
            Temperature, 'temperature', self.temperature_callback, 10)

    def temperature_callback(self, reading: Temperature) -> None:
        """Answer a reading that is a number with an average."""
        if isfinite(reading.celsius):
            self.readings.append(reading.celsius)
            self.readings = self.readings[-self.window:]
            average = Temperature()
            average.stamp = reading.stamp
            average.celsius = fmean(self.readings)
            self.publisher.publish(average)


def main(args=None) -> None:
    """Start the program."""
    run(Smoother, args)


if __name__ == '__main__':
    main()
