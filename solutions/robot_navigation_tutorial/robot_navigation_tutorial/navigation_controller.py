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

"""The node that drives: from the clearance to a velocity, ten times a second."""

from geometry_msgs.msg import Twist
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.steering import choose_turn, STRAIGHT

CONTROL_PERIOD = 0.1  # s


class NavigationController(Node):
    """
    Drives where the way is clear, turns where it is not, and stands still when in doubt.

    Subscribes to clearance (robot_navigation_interfaces/Clearance), publishes cmd_vel
    (geometry_msgs/Twist), offers the service enable (std_srvs/SetBool).
    """

    def __init__(self, **kwargs):
        """
        Name the node navigation_controller; declare its parameters, create its endpoints.

        forward_speed: 0.3 m/s, from 0.05 to 0.5. turn_speed: 0.8 rad/s, from 0.1 to 1.5.
        safety_distance: 0.6 m, from 0.3 to 2.0. data_timeout: 0.5 s, from 0.2 to 2.0.
        Queues of 10; a timer calls control every CONTROL_PERIOD. kwargs are passed on to Node.
        """
        super().__init__('navigation_controller', **kwargs)
        declare(self, 'forward_speed', 0.3, 0.05, 0.5, 'm/s, where the way is clear')
        declare(self, 'turn_speed', 0.8, 0.1, 1.5, 'rad/s, where it is not')
        declare(self, 'safety_distance', 0.6, 0.3, 2.0, 'm: anything nearer ahead is in the way')
        declare(self, 'data_timeout', 0.5, 0.2, 2.0, 's: a clearance older than this is stale')
        self.clearance = None
        self.turn = STRAIGHT
        self.enabled = True
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.create_service(SetBool, 'enable', self.enable_callback)
        self.create_timer(CONTROL_PERIOD, self.control)

    def clearance_callback(self, clearance):
        """Remember the clearance, in place of the one before."""
        self.clearance = clearance

    def enable_callback(self, request, response):
        """Let the robot move (data: true) or hold it still (false) until the next request."""
        self.enabled = request.data
        self.get_logger().info('Driving' if self.enabled else 'Held still')
        response.success = True
        return response

    def control(self):
        """
        Publish exactly one command at each call, even to stand still.

        Disabled, or without a clearance that can be trusted: stand still. Otherwise turn on
        the spot at up to turn_speed, or drive straight on at up to forward_speed, as
        choose_turn says.
        """
        command = Twist()
        if self.enabled and self.is_trusted(self.clearance):
            limit = self.get_parameter('safety_distance').value
            self.turn = choose_turn(self.clearance, limit, self.turn)
            if self.turn == STRAIGHT:
                command.linear.x = self.get_parameter('forward_speed').value
            else:
                command.angular.z = self.turn * self.get_parameter('turn_speed').value
        self.publisher.publish(command)

    def is_trusted(self, clearance):
        """Return whether there is a valid clearance whose stamp is at most data_timeout old."""
        if clearance is None or not clearance.valid:
            return False
        age = self.get_clock().now() - Time.from_msg(clearance.header.stamp)
        return age <= Duration(seconds=self.get_parameter('data_timeout').value)


def main(args=None):
    """Run the node until it is told to stop."""
    run(NavigationController, args)


if __name__ == '__main__':
    main()
