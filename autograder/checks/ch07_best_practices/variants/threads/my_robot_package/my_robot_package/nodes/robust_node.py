"""The robust node with a coroutine as the timer's callback, and parameters in a dataclass."""

from dataclasses import dataclass
import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String


class SensorError(Exception):
    """The sensor did not answer."""


def read_sensor(generator, failure_probability):
    """Return 'Success' or raise SensorError."""
    if generator.random() >= failure_probability:
        return "Success"
    raise SensorError


@dataclass(frozen=True)
class Settings:
    """The parameters of the node."""

    failure_probability: float = 0.1
    seed: int = 0
    max_errors: int = 10

    @classmethod
    def declare(cls, node):
        """Declare the parameters, and return their values."""
        unit_range = FloatingPointRange(from_value=0.0, to_value=1.0)
        table = [("failure_probability", cls.failure_probability, ParameterDescriptor(floating_point_range=[unit_range]))]
        for name, low, high in (("seed", 0, 2**31 - 1), ("max_errors", 1, 1000)):
            limits = IntegerRange(from_value=low, to_value=high)
            table.append((name, getattr(cls, name), ParameterDescriptor(integer_range=[limits])))
        return cls(**{p.name: p.value for p in node.declare_parameters("", table)})


class RobustNode(Node):
    """A node that reads a sensor once a second."""

    def __init__(self, generator=None, **kwargs):
        """Declare the parameters, and create the publisher and the timer."""
        super().__init__("robust_node", **kwargs)
        self.settings = Settings.declare(self)
        self.errors = 0
        self.generator = generator
        if generator is None:
            self.generator = random.Random(self.settings.seed) if self.settings.seed else random.SystemRandom()
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_publisher(String, "status", qos)
        self.create_timer(1.0, self.async_callback, callback_group=ReentrantCallbackGroup())

    async def async_callback(self):
        """Call the plain callback in a task."""
        self.timer_callback()

    def timer_callback(self):
        """Publish the result of a reading."""
        self.publisher.publish(String(data=self.read_status()))

    def read_status(self):
        """Read the sensor once, and return the text of the status."""
        try:
            read_sensor(self.generator, self.settings.failure_probability)
        except SensorError:
            return self.record_failure()
        errors, self.errors = self.errors, 0
        if errors > 0:
            self.get_logger().info(f"Recovered after {errors} errors")
        return "ok"

    def record_failure(self):
        """Count and log a failure, and return the text of the status."""
        self.errors += 1
        self.get_logger().error("The sensor did not answer", throttle_duration_sec=5.0)
        if self.errors <= self.settings.max_errors:
            return f"failed: {self.errors} in a row"
        if self.errors - 1 == self.settings.max_errors:
            self.get_logger().fatal("This is too much")
        return f"unstable: {self.errors} in a row"


def main():
    """Run the node until it is interrupted."""
    rclpy.init()
    node = RobustNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
