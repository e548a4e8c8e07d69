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

"""A switch with two thresholds."""

from enum import Enum
import math

from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.node import Node

from motor_guard.running import run

QUEUE = 10


class Heat(Enum):
    """What a temperature means to the fan."""

    HIGH = True
    LOW = False
    BETWEEN = None
    UNKNOWN = 'the fan had better run'


class Guard(Node):
    """Publishes a decision for each temperature on smoothed."""

    def __init__(self, **kwargs):
        """Hand kwargs to Node."""
        super().__init__('guard', **kwargs)
        self._hot = self.declare_parameter('hot', 60.0).get_parameter_value().double_value
        self._cool = self.declare_parameter('cool', 50.0).get_parameter_value().double_value
        room = self._hot > self._cool  # false when one of them is nan
        if not room:
            raise ValueError('cool must be less than hot')
        self._runs = False
        self.publisher = self.create_publisher(Decision, 'decision', QUEUE)
        self.create_subscription(Temperature, 'smoothed', self.smoothed_callback, QUEUE)

    def _judge(self, celsius):
        """Return the heat of a temperature."""
        if not math.isfinite(celsius):
            return Heat.UNKNOWN
        if celsius >= self._hot:
            return Heat.HIGH
        return Heat.LOW if celsius <= self._cool else Heat.BETWEEN

    def smoothed_callback(self, average):
        """Publish a decision. What is not known changes nothing for the time after it."""
        heat = self._judge(average.celsius)
        if heat in (Heat.HIGH, Heat.LOW):
            self._runs = heat.value
        self.publisher.publish(Decision(
            stamp=average.stamp,
            cooling=self._runs or heat is Heat.UNKNOWN,
            celsius=average.celsius,
        ))


def main(args=None):
    """Be an executable."""
    run(Guard, args)


if __name__ == '__main__':
    main()
