"""The robust node with a coroutine for a timer's callback, and parameters in a dataclass."""

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
    """Expected now and then."""


def read_sensor(generator, failure_probability):
    """Ask the generator once."""
    if generator.random() >= failure_probability:
        return "Success"
    raise SensorError


@dataclass(frozen=True)
class Settings:
    """What can be set, with its range."""

    failure_probability: float = 0.1
    seed: int = 0
    max_errors: int = 10

    @classmethod
    def declare(cls, node):
        """Declare each, and return what they are."""
        share = FloatingPointRange(from_value=0.0, to_value=1.0)
        table = [("failure_probability", cls.failure_probability, ParameterDescriptor(floating_point_range=[share]))]
        for name, low, high in (("seed", 0, 2**31 - 1), ("max_errors", 1, 1000)):
            limits = IntegerRange(from_value=low, to_value=high)
            table.append((name, getattr(cls, name), ParameterDescriptor(integer_range=[limits])))
        return cls(**{each.name: each.value for each in node.declare_parameters("", table)})


class RobustNode(Node):
    """Reads once a second."""

    def __init__(self, generator=None, **kwargs):
        """Declare and connect."""
        super().__init__("robust_node", **kwargs)
        self.settings = Settings.declare(self)
        self.errors = 0
        self.generator = generator
        if generator is None:
            self.generator = random.Random(self.settings.seed) if self.settings.seed else random.SystemRandom()
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.words = self.create_publisher(String, "status", qos)
        self.create_timer(1.0, self.later, callback_group=ReentrantCallbackGroup())

    async def later(self):
        """Do it in a task."""
        self.timer_callback()

    def timer_callback(self):
        """Say how the reading went."""
        self.words.publish(String(data=self.outcome()))

    def outcome(self):
        """Read, and put it into words."""
        try:
            read_sensor(self.generator, self.settings.failure_probability)
        except SensorError:
            return self.failed()
        errors, self.errors = self.errors, 0
        if errors > 0:
            self.get_logger().info(f"Recovered after {errors} errors")
        return "ok"

    def failed(self):
        """Count an error."""
        self.errors += 1
        self.get_logger().error("The sensor did not answer", throttle_duration_sec=5.0)
        if self.errors <= self.settings.max_errors:
            return f"failed: {self.errors} in a row"
        if self.errors - 1 == self.settings.max_errors:
            self.get_logger().fatal("This is too much")
        return f"unstable: {self.errors} in a row"


def main():
    """Run it."""
    rclpy.init()
    node = RobustNode()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
