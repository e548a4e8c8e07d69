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

"""The node that measures: a simulated thermometer on a motor that warms up and cools down."""

import math

from motor_guard_interfaces.msg import Temperature
from rclpy.node import Node

from motor_guard.running import run

READINGS_A_TURN = 20


class Thermometer(Node):
    """Publishes temperature (motor_guard_interfaces/Temperature), one reading each period."""

    def __init__(self, **kwargs):
        """
        Name the node thermometer; declare its parameters, create publisher and timer.

        period: 0.5 s between two readings. mean: 50.0 degrees Celsius. swing: 20.0 degrees.
        kwargs are passed on to Node.
        """
        super().__init__('thermometer', **kwargs)
        period = self.declare_parameter('period', 0.5).value
        self.mean = self.declare_parameter('mean', 50.0).value
        self.swing = self.declare_parameter('swing', 20.0).value
        self.count = 0
        self.publisher = self.create_publisher(Temperature, 'temperature', 10)
        self.create_timer(period, self.timer_callback)

    def timer_callback(self):
        """
        Publish a reading, stamped with the node's clock.

        Reading number 0, 1, 2, ... is mean + swing * sin(2 pi * number / READINGS_A_TURN).
        """
        angle = 2.0 * math.pi * self.count / READINGS_A_TURN
        self.count += 1
        self.publisher.publish(Temperature(
            stamp=self.get_clock().now().to_msg(),
            celsius=self.mean + self.swing * math.sin(angle)))


def main(args=None):
    """Run the node until it is told to stop."""
    run(Thermometer, args)


if __name__ == '__main__':
    main()
