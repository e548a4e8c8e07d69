"""Node thermometer: a sine that stands for a motor's temperature."""

from itertools import count
from math import pi, sin

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from motor_guard.running import run


class Thermometer(Node):
    """Publishes on temperature."""

    def __init__(self, **kwargs) -> None:
        """Set the node up; kwargs are those of Node."""
        super().__init__('thermometer', **kwargs)
        for name, default in (('period', 0.5), ('mean', 50.0), ('swing', 20.0)):
            self.declare_parameter(name, default)
        self.mean = self.get_parameter('mean').value
        self.swing = self.get_parameter('swing').value
        self.numbers = count()
        self.publisher = self.create_publisher(Temperature, 'temperature', 10)
        self.timer = self.create_timer(self.get_parameter('period').value, self.timer_callback)

    def timer_callback(self) -> None:
        """Measure once."""
        message = Temperature()
        message.stamp = self.get_clock().now().to_msg()
        message.celsius = self.reading(next(self.numbers))
        self.publisher.publish(message)

    def reading(self, number: int) -> float:
        """Return reading number 0, 1, 2, ... in degrees Celsius."""
        return self.mean + self.swing * sin(2 * pi * number / 20)


def main(args=None) -> None:
    """Start the program."""
    run(Thermometer, args)


if __name__ == '__main__':
    main()
