"""The robust node by a generator function: it is sent whether a reading failed, and yields what to say."""

import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String


class SensorError(OSError):
    """No answer."""


def read_sensor(generator, failure_probability):
    """Fail as often as asked."""
    failed = generator.random() < failure_probability
    if failed:
        raise SensorError("no answer")
    return "Success"


def counter(max_errors):
    """Yield the words for each reading, and the errors before it."""
    errors = before = 0
    words = ""
    while True:
        failed = yield words, errors, before
        before, errors = errors, (errors + 1 if failed else 0)
        word = "unstable" if errors > max_errors else "failed"
        words = f"{word}: {errors} in a row" if errors else "ok"


class RobustNode(Node):
    """Says how its readings go."""

    def __init__(self, generator=None, **kwargs):
        """Declare, connect, and start the counter."""
        super().__init__("robust_node", **kwargs)
        probability = ParameterDescriptor(
            description="of a failure", floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)])
        self.probability = self.declare_parameter("failure_probability", 0.1, probability).value
        self.most = self._integer("max_errors", 10, (1, 1000))
        seed = self._integer("seed", 0, (0, 2147483647))
        if generator is None:
            generator = random.Random() if seed == 0 else random.Random(seed)
        self.generator = generator
        self.counter = counter(self.most)
        next(self.counter)
        self.status = self.create_publisher(String, "status", QoSProfile(
            depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self.create_timer(1.0, self.timer_callback)

    def _integer(self, name, default, limits):
        bounds = IntegerRange(from_value=limits[0], to_value=limits[1], step=1)
        return self.declare_parameter(name, default, ParameterDescriptor(integer_range=[bounds])).value

    def timer_callback(self):
        """Read, count, log, say."""
        log, failed = self.get_logger(), False
        try:
            read_sensor(self.generator, self.probability)
        except SensorError as error:
            failed = True
            log.error(str(error), throttle_duration_sec=5)
        words, errors, before = self.counter.send(failed)
        if errors == self.most + 1:
            log.fatal(words)
        if before and not errors:
            log.info(f"Recovered after {before} errors")
        self.status.publish(String(data=words))


def main(args=None):
    """Run it."""
    rclpy.init(args=args)
    try:
        rclpy.spin(RobustNode())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
