"""The robust node with a generator function that counts failures and yields statuses."""

import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String


class SensorError(OSError):
    """The sensor did not answer."""


def read_sensor(generator, failure_probability):
    """Return 'Success' or raise SensorError."""
    failed = generator.random() < failure_probability
    if failed:
        raise SensorError("no answer")
    return "Success"


def counter(max_errors):
    """Yield the status, the count and the previous count for each reading that is sent."""
    errors = previous = 0
    status_text = ""
    while True:
        failed = yield status_text, errors, previous
        previous, errors = errors, (errors + 1 if failed else 0)
        word = "unstable" if errors > max_errors else "failed"
        status_text = f"{word}: {errors} in a row" if errors else "ok"


class RobustNode(Node):
    """A node that publishes the results of its readings."""

    def __init__(self, generator=None, **kwargs):
        """Declare the parameters, create the endpoints, and start the counter."""
        super().__init__("robust_node", **kwargs)
        probability = ParameterDescriptor(
            description="of a failure", floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)])
        self.probability = self.declare_parameter("failure_probability", 0.1, probability).value
        self.max_errors = self._integer("max_errors", 10, (1, 1000))
        seed = self._integer("seed", 0, (0, 2147483647))
        if generator is None:
            generator = random.Random() if seed == 0 else random.Random(seed)
        self.generator = generator
        self.counter = counter(self.max_errors)
        next(self.counter)
        self.status = self.create_publisher(String, "status", QoSProfile(
            depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self.create_timer(1.0, self.timer_callback)

    def _integer(self, name, default, limits):
        bounds = IntegerRange(from_value=limits[0], to_value=limits[1], step=1)
        return self.declare_parameter(name, default, ParameterDescriptor(integer_range=[bounds])).value

    def timer_callback(self):
        """Read the sensor once, count, log and publish."""
        log, failed = self.get_logger(), False
        try:
            read_sensor(self.generator, self.probability)
        except SensorError as error:
            failed = True
            log.error(str(error), throttle_duration_sec=5)
        status_text, errors, previous = self.counter.send(failed)
        if errors == self.max_errors + 1:
            log.fatal(status_text)
        if previous and not errors:
            log.info(f"Recovered after {previous} errors")
        self.status.publish(String(data=status_text))


def main(args=None):
    """Run the node until it is interrupted."""
    rclpy.init(args=args)
    try:
        rclpy.spin(RobustNode())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
