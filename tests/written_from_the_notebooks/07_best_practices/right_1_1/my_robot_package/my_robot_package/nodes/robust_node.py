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

"""A sensor that fails now and then, and a node that says so and goes on."""

import random
import time

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

# A node that joins late gets the last status immediately if it asks for the same durability.
STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD = 1.0  # s
QUIET = 5.0  # s: between two lines of the log about failures


class SensorError(RuntimeError):
    """The sensor did not answer: the one failure that the node expects."""


def read_sensor(generator, failure_probability):
    """Return 'Success', or raise SensorError with the given probability."""
    drawn = generator.random()
    if not drawn < failure_probability:
        return 'Success'
    raise SensorError(f'{drawn:.3f} was drawn')


class RobustNode(Node):
    """Reads a sensor once a second, and publishes on status how it went."""

    def __init__(self, generator=None, **kwargs):
        """Name the node robust_node; draw from generator; hand kwargs on to Node."""
        super().__init__('robust_node', **kwargs)
        self.declare_parameter('failure_probability', 0.1, ParameterDescriptor(
            description='the share of the readings that fail',
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)]))
        seed = self._declare_integer(
            'seed', 0, 0, 2147483647, 'where the random numbers begin; 0 is anywhere')
        self._max_errors = self._declare_integer(
            'max_errors', 10, 1, 1000, 'how many failures in a row are no more than bad luck')
        if generator is None:
            generator = random.Random(seed or None)
        self.generator = generator
        self._failures = 0  # in a row
        self._quiet_until = 0.0  # by time.monotonic()
        self._status = self.create_publisher(String, 'status', STATUS_QOS)
        self._timer = self.create_timer(PERIOD, self.timer_callback)

    def _declare_integer(self, name, default, lowest, highest, description):
        bounds = IntegerRange(from_value=lowest, to_value=highest)
        descriptor = ParameterDescriptor(
            description=description, integer_range=[bounds], read_only=True)
        return self.declare_parameter(name, default, descriptor).value

    def timer_callback(self):
        """Read the sensor once; log and publish what happened."""
        probability = self.get_parameter('failure_probability').value
        try:
            read_sensor(self.generator, probability)
        except SensorError as error:
            said = self._failed(error)
        else:
            said = self._succeeded()
        self._status.publish(String(data=said))

    def _failed(self, error):
        self._failures += 1
        now = time.monotonic()
        if now >= self._quiet_until:
            self._quiet_until = now + QUIET
            self.get_logger().error(f'failure {self._failures}: {error}')
        beyond = self._failures - self._max_errors
        if beyond == 1:
            self.get_logger().fatal(f'more than {self._max_errors} failures in a row')
        return f'{"unstable" if beyond > 0 else "failed"}: {self._failures} in a row'

    def _succeeded(self):
        failures, self._failures = self._failures, 0
        if failures:
            self.get_logger().info(f'Recovered after {failures} errors')
        return 'ok'


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
