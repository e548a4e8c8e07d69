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

"""The switch of the fan."""

from math import isfinite

from rclpy.node import Node

from motor_guard.running import run
from motor_guard_interfaces.msg import Decision, Temperature


class Guard(Node):
    """The node guard, which turns smoothed into decision."""

    def __init__(self, **kwargs):
        """Hand kwargs on to Node; read hot and cool. Raise ValueError unless cool < hot."""
        super().__init__('guard', **kwargs)
        self._cool = self.declare_parameter('cool', 50.0).value
        self._hot = self.declare_parameter('hot', 60.0).value
        if self._cool < self._hot:
            self._fan = False
            self._topic = self.create_publisher(Decision, 'decision', 10)
            self.create_subscription(Temperature, 'smoothed', self._on_average, 10)
        else:
            raise ValueError(f'{self._cool} degrees (cool) must be below {self._hot} (hot)')

    def _decide(self, celsius):
        if not isfinite(celsius):
            return True
        if self._cool < celsius < self._hot:
            return self._fan
        return celsius >= self._hot

    def _on_average(self, msg):
        self._fan = self._decide(msg.celsius)
        decision = Decision()
        decision.stamp = msg.stamp
        decision.celsius = msg.celsius
        decision.cooling = self._fan
        self._topic.publish(decision)


def main(args=None):
    """Run it."""
    run(Guard, args)


if __name__ == '__main__':
    main()
