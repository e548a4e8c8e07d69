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

"""Measure the temperature of a motor that is not there."""

import cmath
import functools
import math

import motor_guard.running
import motor_guard_interfaces.msg
import rclpy.node

STEP = cmath.rect(1.0, math.pi / 10.0)  # a twentieth of a turn


class Thermometer(rclpy.node.Node):
    """A motor that gets warm and cold again, and its thermometer."""

    def __init__(self, **kwargs):
        """Hand kwargs on to Node."""
        super().__init__('thermometer', **kwargs)
        self.declare_parameters('', [('swing', 20.0), ('mean', 50.0), ('period', 0.5)])
        values = self.get_parameters(['period', 'mean', 'swing'])
        period, self.middle, self.amplitude = (parameter.value for parameter in values)
        self.phase = 0  # in twentieths of a turn
        self.out = self.create_publisher(motor_guard_interfaces.msg.Temperature, 'temperature', 10)
        self.create_timer(period, self.timer_callback)

    def timer_callback(self):
        """Publish a reading, and let the motor work on."""
        self.out.publish(motor_guard_interfaces.msg.Temperature(
            celsius=self.middle + self.amplitude * (STEP ** self.phase).imag,
            stamp=self.get_clock().now().to_msg()))
        self.phase = (self.phase + 1) % 20


main = functools.partial(motor_guard.running.run, Thermometer)

if __name__ == '__main__':
    main()
