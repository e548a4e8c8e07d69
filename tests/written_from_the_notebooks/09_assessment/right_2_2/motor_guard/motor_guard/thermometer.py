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

"""A motor that works and rests, and how warm that makes it."""

import cmath
import math

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from motor_guard.running import run

QUEUE = 10


def readings(mean, swing):
    """Yield one reading after the other, for ever (degrees Celsius)."""
    turn = [cmath.rect(1.0, math.tau * number / 20).imag for number in range(20)]
    while True:
        for sine in turn:
            yield mean + swing * sine


class Thermometer(Node):
    """Publishes what readings yields."""

    def __init__(self, **kwargs):
        """Hand kwargs to Node."""
        super().__init__('thermometer', **kwargs)
        period, mean, swing = (
            parameter.value for parameter in self.declare_parameters(
                namespace='', parameters=[('period', 0.5), ('mean', 50.0), ('swing', 20.0)]))
        self._readings = readings(mean, swing)
        self.publisher = self.create_publisher(Temperature, 'temperature', QUEUE)
        self.create_timer(period, self.timer_callback)

    def timer_callback(self):
        """Publish the next reading, and when it was taken."""
        now = self.get_clock().now()
        self.publisher.publish(Temperature(stamp=now.to_msg(), celsius=next(self._readings)))


def main(args=None):
    """Be an executable."""
    run(Thermometer, args)


if __name__ == '__main__':
    main()
