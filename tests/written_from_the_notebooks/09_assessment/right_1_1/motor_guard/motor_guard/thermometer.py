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

"""A thermometer that is simulated."""

from itertools import count
from math import sin, tau

from rclpy.node import Node

from motor_guard.running import run
from motor_guard_interfaces.msg import Temperature


class Thermometer(Node):
    """The node thermometer, which publishes temperature."""

    def __init__(self, **kwargs):
        """Hand kwargs on to Node; read period, mean and swing, and begin to measure."""
        super().__init__('thermometer', **kwargs)
        period, mean, swing = (
            self.declare_parameter(name, default).value
            for name, default in (('period', 0.5), ('mean', 50.0), ('swing', 20.0)))
        self._celsius = (mean + swing * sin(tau * n / 20.0) for n in count())
        self._topic = self.create_publisher(Temperature, 'temperature', 10)
        self._timer = self.create_timer(period, self.timer_callback)

    def timer_callback(self):
        """Publish the next reading."""
        reading = Temperature()
        reading.celsius = next(self._celsius)
        reading.stamp = self.get_clock().now().to_msg()
        self._topic.publish(reading)


def main(args=None):
    """Run it."""
    run(Thermometer, args)


if __name__ == '__main__':
    main()
