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

"""The node that decides: when the motor's fan runs."""

import math

from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.node import Node

from motor_guard.running import run


class Guard(Node):
    """
    Publishes one decision for each average.

    Subscribes to smoothed (motor_guard_interfaces/Temperature), publishes decision
    (motor_guard_interfaces/Decision).
    """

    def __init__(self, **kwargs):
        """
        Name the node guard; declare its parameters, create its topics. The fan is off.

        hot: 60.0 degrees Celsius. cool: 50.0 degrees. kwargs are passed on to Node. Raise
        an error, such as ValueError, unless cool is less than hot: without a gap, the fan
        would switch all the time.
        """
        super().__init__('guard', **kwargs)
        self.hot = self.declare_parameter('hot', 60.0).value
        self.cool = self.declare_parameter('cool', 50.0).value
        if not self.cool < self.hot:
            raise ValueError(f'cool is {self.cool}, it must be less than hot, {self.hot}')
        self.cooling = False
        self.publisher = self.create_publisher(Decision, 'decision', 10)
        self.create_subscription(Temperature, 'smoothed', self.smoothed_callback, 10)

    def smoothed_callback(self, average):
        """
        Decide, and publish the decision with the stamp and the temperature of the average.

        At hot or more the fan runs, at cool or less it does not; between the two it stays
        as it was. A temperature that is not finite is unknown, and the fan runs.
        """
        if not math.isfinite(average.celsius) or average.celsius >= self.hot:
            self.cooling = True
        elif average.celsius <= self.cool:
            self.cooling = False
        self.publisher.publish(Decision(
            stamp=average.stamp, cooling=self.cooling, celsius=average.celsius))


def main(args=None):
    """Run the node until it is told to stop."""
    run(Guard, args)


if __name__ == '__main__':
    main()
