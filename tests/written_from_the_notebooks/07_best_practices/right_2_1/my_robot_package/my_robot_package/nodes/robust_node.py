"""Node robust_node: a sensor that may fail, and a status that says so."""

import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD = 1.0  # s


class SensorError(RuntimeError):
    """The sensor did not answer."""


def read_sensor(generator, failure_probability):
    """Ask the generator once; fail when its number is below the probability."""
    number = generator.random()
    if number >= failure_probability:
        return 'Success'
    raise SensorError(f'no answer ({number:.3f} is below {failure_probability:g})')


class Streak:
    """Counts failures in a row; knows nothing of ROS."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.length = 0

    def fail(self) -> bool:
        """Count a failure; return whether it is the one that goes over the limit."""
        self.length += 1
        return self.length == self.limit + 1

    def succeed(self) -> int:
        """End the row; return how long it was."""
        length, self.length = self.length, 0
        return length

    def __str__(self) -> str:
        """Say it as status does."""
        if self.length == 0:
            return 'ok'
        kind = 'failed' if self.length <= self.limit else 'unstable'
        return f'{kind}: {self.length} in a row'


class RobustNode(Node):
    """Reads once a second, and publishes on status how it went."""

    def __init__(self, generator=None, **kwargs) -> None:
        super().__init__('robust_node', **kwargs)
        probability = ParameterDescriptor()
        probability.description = 'share of the readings that fail'
        probability.read_only = True
        probability.floating_point_range.append(FloatingPointRange(from_value=0.0, to_value=1.0))
        self.declare_parameter('failure_probability', 0.1, probability)
        self.failure_probability = self.get_parameter('failure_probability').value
        seed = self._declare_integer('seed', 0, 0, 2147483647, 'where the random numbers start')
        self.max_errors = self._declare_integer(
            'max_errors', 10, 1, 1000, 'how many failures in a row are still stable')
        if generator is None:
            generator = random.Random(seed if seed != 0 else None)
        self.generator = generator
        self.streak = Streak(self.max_errors)
        self.publisher = self.create_publisher(String, 'status', STATUS_QOS)
        self.timer = self.create_timer(PERIOD, self.timer_callback)

    def _declare_integer(self, name, default, lowest, highest, description):
        bounds = IntegerRange(from_value=lowest, to_value=highest)
        descriptor = ParameterDescriptor(
            description=description, integer_range=[bounds], read_only=True)
        return self.declare_parameter(name, default, descriptor).value

    def timer_callback(self) -> None:
        """Read once, and tell everybody."""
        try:
            read_sensor(self.generator, self.failure_probability)
        except SensorError as error:
            self._failed(error)
        else:
            self._succeeded()
        self.publisher.publish(String(data=str(self.streak)))

    def _failed(self, error: SensorError) -> None:
        goes_over = self.streak.fail()
        self.get_logger().error(str(error), throttle_duration_sec=5.0)
        if goes_over:
            self.get_logger().fatal(f'{self.streak}; I go on all the same')

    def _succeeded(self) -> None:
        errors = self.streak.succeed()
        if errors > 0:
            self.get_logger().info(f'Recovered after {errors} errors')


def main(args=None) -> None:
    """Spin the node until a signal ends it."""
    rclpy.init(args=args)
    try:
        node = RobustNode()
        try:
            rclpy.spin(node)
        finally:
            node.destroy_node()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
