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

"""A moving average."""

from math import isfinite
from statistics import fmean

from rclpy.node import Node

from motor_guard.running import run
from motor_guard_interfaces.msg import Temperature


class Smoother(Node):
    """The node smoother, which turns temperature into smoothed."""

    def __init__(self, **kwargs):
        """Hand kwargs on to Node; read window. Raise ValueError unless it is from 1 to 100."""
        super().__init__('smoother', **kwargs)
        self._window = self.declare_parameter('window', 5).value
        if self._window not in range(1, 101):
            raise ValueError(f'window must be from 1 to 100, and is {self._window}')
        self._readings = []
        self._topic = self.create_publisher(Temperature, 'smoothed', 10)
        self.create_subscription(Temperature, 'temperature', self._on_reading, 10)

    def _on_reading(self, msg):
        if isfinite(msg.celsius):
            self._readings = [*self._readings, msg.celsius][-self._window:]
            msg.celsius = fmean(self._readings)
            self._topic.publish(msg)


def main(args=None):
    """Run it."""
    run(Smoother, args)


if __name__ == '__main__':
    main()
