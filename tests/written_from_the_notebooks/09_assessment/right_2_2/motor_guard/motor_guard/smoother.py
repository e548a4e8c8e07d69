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

"""A moving average over a ring of readings."""

import math

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.node import Node

from motor_guard.running import run

QUEUE = 10
WINDOWS = IntegerRange(from_value=1, to_value=100, step=1)


class MovingAverage:
    """The mean of the newest numbers; knows nothing of ROS."""

    def __init__(self, window):
        """Make room for so many numbers."""
        self._window = window
        self._ring = {}
        self._count = 0

    def add(self, number):
        """Take a number in, and return the mean of the newest."""
        self._ring[self._count % self._window] = number
        self._count += 1
        return math.fsum(self._ring.values()) / len(self._ring)


class Smoother(Node):
    """Publishes smoothed for each temperature that is a finite number."""

    def __init__(self, **kwargs):
        """Hand kwargs to Node."""
        super().__init__('smoother', **kwargs)
        descriptor = ParameterDescriptor(
            description='readings in an average', integer_range=[WINDOWS], read_only=True)
        self.declare_parameter('window', 5, descriptor)
        self._average = MovingAverage(self.get_parameter('window').value)
        self.publisher = self.create_publisher(Temperature, 'smoothed', QUEUE)
        self.create_subscription(Temperature, 'temperature', self.temperature_callback, QUEUE)

    def temperature_callback(self, reading):
        """Publish an average, unless the reading says nothing."""
        if math.isnan(reading.celsius) or math.isinf(reading.celsius):
            self.get_logger().warning('That is no temperature', throttle_duration_sec=5.0)
            return
        reading.celsius = self._average.add(reading.celsius)
        self.publisher.publish(reading)


def main(args=None):
    """Be an executable."""
    run(Smoother, args)


if __name__ == '__main__':
    main()
