"""A thermometer as a function that returns a node."""
import cmath

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from .running import run


def readings(mean, swing):
    """Yield mean + swing * sin(2 pi n / 20), computed with complex numbers."""
    n = 0
    while True:
        yield mean + swing * cmath.exp(1j * cmath.pi * n / 10).imag
        n += 1


def thermometer(**kwargs):
    node = Node('thermometer', **kwargs)
    period, mean, swing = (
        parameter.value for parameter in node.declare_parameters(
            namespace='', parameters=[('period', 0.5), ('mean', 50.0), ('swing', 20.0)]))
    celsius = readings(mean, swing)
    publisher = node.create_publisher(Temperature, 'temperature', 10)

    def measure():
        msg = Temperature()
        msg.celsius = next(celsius)
        msg.stamp = node.get_clock().now().to_msg()
        publisher.publish(msg)
        node.get_logger().debug(str(msg))

    node.create_timer(period, measure)
    return node


def main(args=None):
    run(thermometer, args)


if __name__ == '__main__':
    main()
