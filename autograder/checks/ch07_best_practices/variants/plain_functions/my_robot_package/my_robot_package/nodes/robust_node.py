"""The robust node with a separate object that counts failures."""

from dataclasses import dataclass
import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import String


class SensorError(Exception):
    """The sensor failed."""


def read_sensor(generator, failure_probability):
    """Return 'Success' or raise SensorError."""
    number = generator.random()
    if not number < failure_probability:
        return "Success"
    raise SensorError(f"drew {number:.3f}")


@dataclass
class Streak:
    """Failures in a row."""

    limit: int
    length: int = 0

    def status_text(self):
        """Return the text of the status."""
        if not self.length:
            return "ok"
        return f"{'failed' if self.length <= self.limit else 'unstable'}: {self.length} in a row"


class RobustNode(Node):
    """Reads its sensor once a second."""

    def __init__(self, generator=None, **kwargs):
        """Declare the parameters, and create the publisher and the timer."""
        super().__init__("robust_node", **kwargs)
        self.declare_parameters(
            "",
            [
                (
                    "failure_probability",
                    0.1,
                    ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)]),
                ),
                ("seed", 0, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=2**31 - 1)])),
                ("max_errors", 10, ParameterDescriptor(integer_range=[IntegerRange(from_value=1, to_value=1000)])),
            ],
        )
        seed = self.get_parameter("seed").value
        self._generator = random.Random(seed or None) if generator is None else generator
        self._streak = Streak(self.get_parameter("max_errors").value)
        self._status = self.create_publisher(
            String,
            "status",
            QoSProfile(
                depth=1,
                reliability=QoSReliabilityPolicy.RELIABLE,
                durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
            ),
        )
        self._timer = self.create_timer(1.0, self.timer_callback)

    def timer_callback(self):
        """Read the sensor once, log and publish."""
        failure = None
        try:
            read_sensor(self._generator, self.get_parameter("failure_probability").value)
        except SensorError as error:
            failure = error
        before = self._streak.length
        self._streak.length = 0 if failure is None else before + 1
        if failure is not None:
            self.get_logger().error(f"no reading: {failure}", throttle_duration_sec=5.0)
            if self._streak.length == self._streak.limit + 1:
                self.get_logger().fatal("this is no longer normal")
        elif before:
            self.get_logger().info(f"Recovered after {before} errors")
        self._status.publish(String(data=self._streak.status_text()))


def main(args=None):
    """Spin until the node is interrupted."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobustNode()
        executor = rclpy.executors.SingleThreadedExecutor()
        executor.add_node(node)
        while rclpy.ok():
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
