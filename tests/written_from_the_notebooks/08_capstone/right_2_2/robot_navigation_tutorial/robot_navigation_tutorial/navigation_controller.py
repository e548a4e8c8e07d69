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

"""The legs: clearances become velocities, slower ones where there is less room."""

from geometry_msgs.msg import Twist
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.steering import choose_turn, STRAIGHT

FREQUENCY = 10.0  # Hz
BRAKING = 0.5  # m beyond the safety distance where the robot is slower
SLOWEST = 0.5  # of forward_speed


class NavigationController(Node):
    """Publishes on cmd_vel, hears clearance, serves enable."""

    def __init__(self, **kwargs):
        """Hand kwargs to Node."""
        super().__init__('navigation_controller', **kwargs)
        declare(self, 'forward_speed', 0.3, 0.05, 0.5, 'm/s')
        declare(self, 'turn_speed', 0.8, 0.1, 1.5, 'rad/s')
        declare(self, 'safety_distance', 0.6, 0.3, 2.0, 'm, to what is ahead')
        declare(self, 'data_timeout', 0.5, 0.2, 2.0, 's, since the scan was taken')
        self._latest = []
        self._turn = STRAIGHT
        self._held = False
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.create_service(SetBool, 'enable', self.enable_callback)
        self.create_timer(1.0 / FREQUENCY, self.control)

    def clearance_callback(self, clearance):
        """Let the new one take the place of the old one."""
        self._latest[:] = [clearance]

    def enable_callback(self, request, response):
        """Hold the robot still, or no longer."""
        self._held = not request.data
        if self._held:
            self.get_logger().info('Held still')
        else:
            self.get_logger().info('Free to go')
        response.success = True
        return response

    def control(self):
        """Decide and command."""
        speed, turn_rate = self._decide()
        command = Twist()
        command.linear.x = speed
        command.angular.z = turn_rate
        self.publisher.publish(command)

    def _decide(self):
        """Return how fast to drive (m/s) and to turn (rad/s)."""
        usable = [clearance for clearance in self._latest if self._is_fresh(clearance)]
        if self._held or not usable:
            return 0.0, 0.0
        clearance, = usable
        safety_distance, forward_speed, turn_speed = (
            parameter.value for parameter in self.get_parameters(
                ['safety_distance', 'forward_speed', 'turn_speed']))
        self._turn = choose_turn(clearance, safety_distance, self._turn)
        if self._turn != STRAIGHT:
            return 0.0, 0.75 * self._turn * turn_speed
        room = (clearance.front - safety_distance) / BRAKING
        return forward_speed * min(1.0, max(SLOWEST, room)), 0.0

    def _is_fresh(self, clearance):
        """Return whether a clearance is valid, and not older than data_timeout."""
        stamp = Time.from_msg(clearance.header.stamp, clock_type=ClockType.ROS_TIME)
        timeout = Duration(seconds=self.get_parameter('data_timeout').value)
        return clearance.valid and not self.get_clock().now() - stamp > timeout


def main(args=None):
    """Be an executable."""
    run(NavigationController, args)


if __name__ == '__main__':
    main()
