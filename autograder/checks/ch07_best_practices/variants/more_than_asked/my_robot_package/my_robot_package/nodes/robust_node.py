"""A sensor that sometimes fails, and a node that tolerates this."""

import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float32, String
from std_srvs.srv import Trigger

from my_robot_package.nodes.common import run_node

STATUS_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD = 1.0


class SensorError(RuntimeError):
    """The sensor did not answer."""


def read_sensor(generator, failure_probability):
    """Return 'Success' or raise SensorError."""
    drawn = generator.random()
    if drawn >= failure_probability:
        return 'Success'
    raise SensorError(f'no answer: {drawn:.3f} is below {failure_probability:.3f}')


class RobustNode(Node):
    """A node that reads a sensor once a second and publishes the result."""

    def __init__(self, generator=None, **kwargs):
        """Declare the parameters, then create the endpoints and the timer."""
        super().__init__('robust_node', **kwargs)
        self.declare_parameters('', [
            ('failure_probability', 0.1, ParameterDescriptor(
                description='how often a reading fails', read_only=True,
                floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)])),
            ('seed', 0, ParameterDescriptor(
                description='of the generator; 0: none', read_only=True,
                integer_range=[IntegerRange(from_value=0, to_value=2**31 - 1, step=1)])),
            ('max_errors', 10, ParameterDescriptor(
                description='failures in a row that are borne', read_only=True,
                integer_range=[IntegerRange(from_value=1, to_value=1000, step=1)])),
        ])
        seed = self.get_parameter('seed').value
        self.generator = generator if generator is not None else random.Random(seed or None)
        self.failures = 0
        self.last_error = None
        self.out = self.create_publisher(String, 'status', STATUS_QOS)
        self.create_timer(PERIOD, self.timer_callback, callback_group=ReentrantCallbackGroup())
        self.service = self.create_service(Trigger, '~/how_are_you', self.answer)
        self.rate_out = self.create_publisher(Float32, '~/failure_rate', 10)
        self.declare_parameter('sensor_name', 'front')
        self.readings = self.failed_readings = 0
        self.add_on_set_parameters_callback(self.validate)
        self.get_logger().warning('this sensor is simulated')
        self.get_logger().info('Started.\nReads once a second.')

    def validate(self, parameters):
        """Refuse an empty name of the sensor."""
        return SetParametersResult(
            successful=all(p.value != '' for p in parameters), reason='a sensor needs a name')

    def answer(self, request, response):
        """Answer with the number of failures."""
        response.success = self.failures == 0
        response.message = f'{self.failures} failures'
        return response

    def timer_callback(self):
        """Read the sensor once, and publish the status."""
        try:
            read_sensor(self.generator, self.get_parameter('failure_probability').value)
        except SensorError as error:
            self.out.publish(String(data=self.record_failure(error)))
            return
        self.readings += 1
        self.rate_out.publish(Float32(data=self.failed_readings / self.readings))
        before, self.failures = self.failures, 0
        if before:
            self.get_logger().info(f'Recovered after {before} errors')
        self.out.publish(String(data='ok'))

    def record_failure(self, error):
        """Count and log a failure, and return the text of the status."""
        self.failures += 1
        self.readings += 1
        self.failed_readings += 1
        max_errors = self.get_parameter('max_errors').value
        now = self.get_clock().now()
        if self.last_error is None or now - self.last_error >= Duration(seconds=5.0):
            self.last_error = now
            self.get_logger().error(f'reading failed: {error}')
        if self.failures == max_errors + 1:
            self.get_logger().fatal(f'{self.failures} failures in a row')
        word = 'unstable' if self.failures > max_errors else 'failed'
        return f'{word}: {self.failures} in a row'


def main(args=None):
    """Run the node until it is interrupted."""
    run_node(RobustNode, args)


if __name__ == '__main__':
    main()
