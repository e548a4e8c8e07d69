"""A sensor that fails now and then, and a node that bears it."""

import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rcl_interfaces.msg import SetParametersResult
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float32, String
from std_srvs.srv import Trigger

from my_robot_package.nodes.common import serve

STATUS_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD = 1.0


class SensorError(RuntimeError):
    """No answer from the sensor."""


def read_sensor(generator, failure_probability):
    """Return 'Success' or raise SensorError."""
    drawn = generator.random()
    if drawn >= failure_probability:
        return 'Success'
    raise SensorError(f'no answer: {drawn:.3f} is below {failure_probability:.3f}')


class RobustNode(Node):
    """Reads a sensor once a second and tells how it went."""

    def __init__(self, generator=None, **kwargs):
        """Declare, then create."""
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
        self.reset = self.create_service(Trigger, '~/how_are_you', self.answer)
        self.rate_out = self.create_publisher(Float32, '~/failure_rate', 10)
        self.declare_parameter('sensor_name', 'front')
        self.readings = self.bad = 0
        self.add_on_set_parameters_callback(self.judge)
        self.get_logger().warning('this sensor is simulated')
        self.get_logger().info('Started.\nReads once a second.')

    def judge(self, parameters):
        """Refuse an empty name."""
        return SetParametersResult(
            successful=all(p.value != '' for p in parameters), reason='a sensor needs a name')

    def answer(self, request, response):
        """Say how it goes."""
        response.success = self.failures == 0
        response.message = f'{self.failures} failures'
        return response

    def timer_callback(self):
        """Read once."""
        try:
            read_sensor(self.generator, self.get_parameter('failure_probability').value)
        except SensorError as error:
            self.out.publish(String(data=self.failed(error)))
            return
        self.readings += 1
        self.rate_out.publish(Float32(data=self.bad / self.readings))
        before, self.failures = self.failures, 0
        if before:
            self.get_logger().info(f'Recovered after {before} errors')
        self.out.publish(String(data='ok'))

    def failed(self, error):
        """Count and log a failure; return what status says."""
        self.failures += 1
        self.readings += 1
        self.bad += 1
        most = self.get_parameter('max_errors').value
        now = self.get_clock().now()
        if self.last_error is None or now - self.last_error >= Duration(seconds=5.0):
            self.last_error = now
            self.get_logger().error(f'reading failed: {error}')
        if self.failures == most + 1:
            self.get_logger().fatal(f'{self.failures} failures in a row')
        word = 'unstable' if self.failures > most else 'failed'
        return f'{word}: {self.failures} in a row'


def main(args=None):
    """Run."""
    serve(RobustNode, args)


if __name__ == '__main__':
    main()
