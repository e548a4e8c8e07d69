# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A node that goes on when its sensor fails, and ends when there is a bug."""

from random import Random
import time

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String

STATUS_QOS = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
PERIOD = 1.0  # s
ERROR_PERIOD = 5.0  # s between two lines of level error


class SensorError(RuntimeError):
    """What read_sensor raises when it has to."""


def read_sensor(generator, failure_probability):
    """Return 'Success', or raise SensorError as often as failure_probability says."""
    fails = generator.random() < failure_probability
    if fails:
        raise SensorError('the sensor is silent')
    return 'Success'


class RobustNode(Node):
    """Publishes on status, once a second, whether its sensor could be read."""

    def __init__(self, generator=None, **kwargs):
        """Take the numbers from the generator, or from one with the parameter seed."""
        super().__init__('robust_node', **kwargs)
        limits = FloatingPointRange(from_value=0.0, to_value=1.0)
        self.failure_probability = self.declare_parameter(
            'failure_probability', 0.1, ParameterDescriptor(
                description='probability of a failure, 0 to 1',
                floating_point_range=[limits],
                read_only=True)).value
        whole = {
            name: self._declare_integer(name, default, lowest, highest, description)
            for name, default, lowest, highest, description in (
                ('seed', 0, 0, (1 << 31) - 1, 'seed of the generator, 0 for none'),
                ('max_errors', 10, 1, 1000, 'longest row of failures that is no alarm'),
            )
        }
        self.max_errors = whole['max_errors']
        seeds = [whole['seed']] if whole['seed'] else []
        self.generator = Random(*seeds) if generator is None else generator
        self._failures = []  # those since the last success
        self._next_error = float('-inf')  # s, monotonic
        self.publisher = self.create_publisher(String, 'status', STATUS_QOS)
        self.create_timer(PERIOD, self.timer_callback)
        self.get_logger().info(f'Reading each {PERIOD:g} s')

    def _declare_integer(self, name, default, lowest, highest, description):
        bounds = IntegerRange(from_value=lowest, to_value=highest)
        descriptor = ParameterDescriptor(
            description=description, integer_range=[bounds], read_only=True)
        return self.declare_parameter(name, default, descriptor).value

    def timer_callback(self):
        """Read the sensor, log and publish. Only SensorError is caught."""
        failure = None
        try:
            read_sensor(self.generator, self.failure_probability)
        except SensorError as error:
            failure = error
        message = String()
        message.data = 'ok' if failure is None else self._describe(failure)
        if failure is None and self._failures:
            self.get_logger().info(f'Recovered after {len(self._failures)} errors')
            self._failures.clear()
        self.publisher.publish(message)

    def _describe(self, failure):
        """Count a failure, log it, and return what status says of it."""
        self._failures.append(str(failure))
        count = len(self._failures)
        self._log_error(failure)
        over = count - self.max_errors
        if over == 1:
            self.get_logger().fatal(f'Unstable: {count} failures in a row')
        return f"{'unstable' if over > 0 else 'failed'}: {count} in a row"

    def _log_error(self, failure):
        """Log a failure, unless one was logged in the last five seconds."""
        now = time.monotonic()
        if now >= self._next_error:
            self._next_error = now + ERROR_PERIOD
            self.get_logger().error(f'Cannot read: {failure}')


def main(args=None):
    """Run the node in an executor of its own, until SIGINT or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobustNode()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
