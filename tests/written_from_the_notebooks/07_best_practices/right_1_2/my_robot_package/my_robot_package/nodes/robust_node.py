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

"""Read a sensor that is not reliable, and be reliable all the same."""

from itertools import count
import random

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

# A node that joins late gets the last status immediately if it asks for the same durability.
STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class SensorError(RuntimeError):
    """The sensor did not answer: the one failure that the node expects."""


def read_sensor(generator, failure_probability):
    """Return 'Success', or raise SensorError when the generator's number is too low."""
    if failure_probability > generator.random():
        raise SensorError
    return 'Success'


class RobustNode(Node):
    """The node robust_node; its topic is status (std_msgs/String)."""

    def __init__(self, generator=None, **kwargs):
        """Declare what can be set, and begin to read in a second; kwargs are for Node."""
        super().__init__('robust_node', **kwargs)
        limits = FloatingPointRange(from_value=0.0, to_value=1.0)
        descriptor = ParameterDescriptor(
            description='probability that a reading fails', floating_point_range=[limits],
            read_only=True)
        self._probability = self.declare_parameter('failure_probability', 0.1, descriptor).value
        self._limit = self._declare_integer('max_errors', 10, 1, 1000, 'failures that are borne')
        seed = self._declare_integer('seed', 0, 0, 2**31 - 1, 'of the generator; 0 for none')
        if generator is not None:
            self._random = generator
        elif seed == 0:
            self._random = random.Random()
        else:
            self._random = random.Random(seed)
        self._series = count(1)  # numbers the failures since the last success
        self._failures = 0
        self._publisher = self.create_publisher(String, 'status', STATUS_QOS)
        self.create_timer(1.0, self.timer_callback)

    def _declare_integer(self, name, default, lowest, highest, description):
        bounds = IntegerRange(from_value=lowest, to_value=highest)
        descriptor = ParameterDescriptor(
            description=description, integer_range=[bounds], read_only=True)
        return self.declare_parameter(name, default, descriptor).value

    def _reading_succeeds(self):
        try:
            return bool(read_sensor(self._random, self._probability))
        except SensorError:
            return False

    def timer_callback(self):
        """Read once."""
        log, status = self.get_logger(), String(data='ok')
        if self._reading_succeeds():
            if self._failures > 0:
                log.info(f'Recovered after {self._failures} errors')
            self._series, self._failures = count(1), 0
        else:
            self._failures = next(self._series)
            log.error('The sensor did not answer', throttle_duration_sec=5.0)
            if self._failures == self._limit + 1:
                log.fatal('The sensor does not answer any more')
            state = 'failed' if self._failures <= self._limit else 'unstable'
            status.data = f'{state}: {self._failures:d} in a row'
        self._publisher.publish(status)


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
