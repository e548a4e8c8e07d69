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

"""The node at the wheel; it slows down where something is near."""

from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.steering import choose_turn, STRAIGHT

CALM = 0.75  # of turn_speed: that is fast enough


def share_of_speed(front, safety_distance):
    """Return which part of forward_speed fits, 0.5 to 1: all of it at twice the distance."""
    return min(1.0, max(0.5, 0.5 * front / safety_distance))


class NavigationController(Node):
    """Listens to clearance, says cmd_vel, obeys enable."""

    def __init__(self, **kwargs):
        """Name it; make its ends; start its clockwork."""
        super().__init__('navigation_controller', **kwargs)
        declare(self, 'forward_speed', 0.3, 0.05, 0.5, 'Highest speed, m/s')
        declare(self, 'turn_speed', 0.8, 0.1, 1.5, 'Highest turn rate, rad/s')
        declare(self, 'safety_distance', 0.6, 0.3, 2.0, 'Nothing ahead may be nearer, m')
        declare(self, 'data_timeout', 0.5, 0.2, 2.0, 'No clearance may be older, s')
        self.clearance, self.turn, self.enabled = None, STRAIGHT, True
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.create_service(SetBool, 'enable', self.enable_callback)
        self.create_timer(0.1, self.control)

    def clearance_callback(self, clearance):
        """Keep the clearance until the next one comes."""
        self.clearance = clearance

    def enable_callback(self, request, response):
        """Switch."""
        response.success = True
        self.enabled = request.data
        return response

    def control(self):
        """Publish a command."""
        names = ['forward_speed', 'turn_speed', 'safety_distance', 'data_timeout']
        forward, turn, safe, timeout = (
            parameter.value for parameter in self.get_parameters(names))
        command = Twist()
        if self.is_current(timeout) and self.clearance.valid and self.enabled:
            self.turn = choose_turn(self.clearance, safe, self.turn)
            if self.turn == STRAIGHT:
                command.linear.x = forward * share_of_speed(self.clearance.front, safe)
            else:
                command.angular.z = self.turn * CALM * turn
        self.publisher.publish(command)

    def is_current(self, timeout):
        """Say whether there is a clearance that is not too old."""
        if self.clearance is None:
            return False
        best_before = Time.from_msg(self.clearance.header.stamp) + Duration(seconds=timeout)
        return not self.get_clock().now() > best_before


def main(args=None):
    """Run the node until it is told to stop."""
    run(NavigationController, args)


if __name__ == '__main__':
    main()
