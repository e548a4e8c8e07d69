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


"""Read a sensor once a second, and publish how it went."""

import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

# A node that joins late gets the last status immediately if it asks for the same durability.
STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD = 1.0  # s


class SensorError(RuntimeError):
    """The sensor did not answer: the one failure that the node expects."""


def read_sensor(generator, failure_probability):
    """
    Return 'Success', or raise SensorError with the given probability.

    It simulates a file, a network or a device. It calls generator.random() once, and
    fails when that number, in [0, 1), is below failure_probability.
    """
    if generator.random() < failure_probability:
        raise SensorError('the sensor did not answer')
    return 'Success'


class RobustNode(Node):
    """
    Read a sensor once a second, and publish on status (std_msgs/String) how it went.

    ok                     the reading succeeded
    failed: 3 in a row     it failed; the count grows until a reading succeeds
    unstable: 11 in a row  it failed more than max_errors times in a row
    """

    def __init__(self, generator=None, **kwargs):
        """
        Declare the parameters, create the publisher (STATUS_QOS) and the timer (PERIOD).

        failure_probability: float, 0.1, from 0 to 1. seed: int, 0, from 0 to 2**31 - 1.
        max_errors: int, 10, from 1 to 1000. The generator is the one that is passed in.
        Without one, it is random.Random(seed), or, if the seed is 0, random.Random(), which
        gives different numbers each time. kwargs are passed on to Node.
        """
        super().__init__('robust_node', **kwargs)
        self.failure_probability = self.declare_parameter(
            'failure_probability',
            0.1,
            ParameterDescriptor(
                description='how often a reading fails, from 0 to 1',
                floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)],
                read_only=True,
            ),
        ).value
        seed = self._declare_integer(
            'seed', 0, 0, 2**31 - 1, 'of the random numbers; 0 for other ones each time')
        self.max_errors = self._declare_integer(
            'max_errors', 10, 1, 1000, 'failures in a row that are still borne')
        self.generator = generator or (random.Random(seed) if seed else random.Random())
        self.error_count = 0
        self.publisher = self.create_publisher(String, 'status', STATUS_QOS)
        self.create_timer(PERIOD, self.timer_callback)
        self.get_logger().info('Robust node initialised')

    def _declare_integer(self, name, default, lowest, highest, description):
        bounds = IntegerRange(from_value=lowest, to_value=highest)
        descriptor = ParameterDescriptor(
            description=description, integer_range=[bounds], read_only=True)
        return self.declare_parameter(name, default, descriptor).value

    def timer_callback(self):
        """
        Read the sensor once, count, log and publish.

        A SensorError is expected: count it, and log it as an error unless one was logged
        less than 5 s before. The failure that makes the node unstable is logged as fatal,
        once. The first success after failures is logged as 'Recovered after N errors', and
        the count starts again. Every other exception is a bug, and is not caught here.
        """
        try:
            read_sensor(self.generator, self.failure_probability)
        except SensorError as error:
            self.error_count += 1
            self.get_logger().error(f'Reading failed: {error}', throttle_duration_sec=5.0)
            if self.error_count == self.max_errors + 1:
                self.get_logger().fatal(f'{self.error_count} errors in a row: unstable')
            unstable = self.error_count > self.max_errors
            word = 'unstable' if unstable else 'failed'
            self.publisher.publish(String(data=f'{word}: {self.error_count} in a row'))
            return
        if self.error_count:
            self.get_logger().info(f'Recovered after {self.error_count} errors')
            self.error_count = 0
        self.publisher.publish(String(data='ok'))


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobustNode()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():  # if not, a signal came between two waits, and rclpy raised this
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
