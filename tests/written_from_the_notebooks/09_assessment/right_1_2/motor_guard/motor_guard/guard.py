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

"""Guard a motor against heat."""

import math

from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.node import Node

from motor_guard import running


class Guard(Node):
    """Decides for each average whether the fan runs; it is off at first."""

    fan = False

    def __init__(self, **kwargs):
        """Hand kwargs on to Node."""
        super().__init__('guard', **kwargs)
        hot = self.declare_parameter('hot', 60.0).get_parameter_value().double_value
        cool = self.declare_parameter('cool', 50.0).get_parameter_value().double_value
        if math.isnan(hot) or math.isnan(cool) or cool >= hot:
            self.get_logger().fatal('cool must be less than hot')
            raise RuntimeError('cool must be less than hot')
        out = self.create_publisher(Decision, 'decision', 10)

        def decide(average):
            celsius = average.celsius
            unknown = math.isnan(celsius) or math.isinf(celsius)
            self.fan = unknown or celsius >= hot or (self.fan and celsius > cool)
            out.publish(Decision(cooling=self.fan, celsius=celsius, stamp=average.stamp))

        self.create_subscription(Temperature, 'smoothed', decide, 10)


def main():
    """Guard until told to stop."""
    running.run(Guard)


if __name__ == '__main__':
    main()
