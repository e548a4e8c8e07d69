"""The robust node as a state machine: FINE, FAILING or UNSTABLE, each with its own reaction."""

from enum import Enum
import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String


class SensorError(RuntimeError):
    """The sensor did not answer."""


class State(Enum):
    """The state of the sensor; the value is the word in its status."""

    FINE = "ok"
    FAILING = "failed"
    UNSTABLE = "unstable"


def read_sensor(generator, failure_probability):
    """Return 'Success' or raise SensorError."""
    if failure_probability <= generator.random():
        return "Success"
    raise SensorError("silence")


class RobustNode(Node):
    """A node that changes its state with each reading."""

    def __init__(self, generator=None, **kwargs):
        """Declare the parameters, and create the publisher and the timer."""
        super().__init__("robust_node", **kwargs)
        self.declare_all()
        seed = self.get_parameter("seed").get_parameter_value().integer_value
        self.generator = generator or random.Random(seed or None)
        self.state, self.failures = State.FINE, 0
        profile = QoSProfile(
            depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.publisher = self.create_publisher(String, "status", profile)
        self.timer = self.create_timer(1.0, self.timer_callback)

    def declare_all(self):
        """Declare the three parameters, read-only."""
        self.declare_parameter("failure_probability", 0.1, ParameterDescriptor(
            description="share of readings that fail", read_only=True,
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0, step=0.0)]))
        for name, default, low, high in (("seed", 0, 0, 2**31 - 1), ("max_errors", 10, 1, 1000)):
            self.declare_parameter(name, default, ParameterDescriptor(
                description=name.replace("_", " "), read_only=True,
                integer_range=[IntegerRange(from_value=low, to_value=high)]))

    def timer_callback(self):
        """Read the sensor once, and change to the next state."""
        try:
            read_sensor(self.generator, self.get_parameter("failure_probability").value)
        except SensorError as error:
            self.get_logger().error(f"{error}", throttle_duration_sec=5.0)
            self.change_to(self.after_failure())
        else:
            self.change_to(State.FINE)
        tail = f": {self.failures} in a row" if self.failures else ""
        self.publisher.publish(String(data=self.state.value + tail))

    def after_failure(self):
        """Count the failure, and return the next state."""
        self.failures += 1
        tolerated = self.failures <= self.get_parameter("max_errors").value
        return State.FAILING if tolerated else State.UNSTABLE

    def change_to(self, state):
        """Log a change of the state, and store the new one."""
        if state is State.UNSTABLE and self.state is not State.UNSTABLE:
            self.get_logger().fatal("unstable from now on")
        if state is State.FINE and self.state is not State.FINE:
            self.get_logger().info(f"Recovered after {self.failures} errors")
            self.failures = 0
        self.state = state


def main(args=None):
    """Run the node with two threads."""
    rclpy.init(args=args)
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(RobustNode())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
