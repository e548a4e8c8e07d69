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

"""Smooth the readings of the thermometer."""

import math

from motor_guard_interfaces.msg import Temperature
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor
from rclpy.node import Node

from motor_guard import running


class Smoother(Node):
    """Keeps the newest readings in a ring."""

    def __init__(self, **kwargs):
        """Hand kwargs on to Node; make a ring with room for window readings."""
        super().__init__('smoother', **kwargs)
        bounds = IntegerRange(from_value=1, to_value=100, step=1)
        self.declare_parameter(
            'window', value=5,
            descriptor=ParameterDescriptor(integer_range=[bounds], read_only=True))
        self.ring = [None] * self.get_parameter('window').get_parameter_value().integer_value
        self.place = 0
        self.create_subscription(Temperature, 'temperature', self.smooth, 10)
        self.out = self.create_publisher(Temperature, 'smoothed', 10)

    def smooth(self, reading):
        """Put the reading into the ring, in place of the oldest, if it is one."""
        if math.isnan(reading.celsius) or math.isinf(reading.celsius):
            return
        self.ring[self.place] = reading.celsius
        self.place = (self.place + 1) % len(self.ring)
        known = [celsius for celsius in self.ring if celsius is not None]
        answer = Temperature(celsius=math.fsum(known) / len(known))
        answer.stamp.sec, answer.stamp.nanosec = reading.stamp.sec, reading.stamp.nanosec
        self.out.publish(answer)


def main():
    """Smooth until told to stop."""
    running.run(Smoother)


if __name__ == '__main__':
    main()
