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

"""The controller as a state machine, which stands still while it cannot trust its data."""

from geometry_msgs.msg import Twist, Vector3
from rclpy.node import Node
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.steering import Straight

PARAMETERS = (
    ('forward_speed', 0.3, 0.05, 0.5, 'm/s'),
    ('turn_speed', 0.8, 0.1, 1.5, 'rad/s'),
    ('safety_distance', 0.6, 0.3, 2.0, 'm'),
    ('data_timeout', 0.5, 0.2, 2.0, 's'),
)


class NavigationController(Node):
    """Publishes ten commands a second."""

    def __init__(self, **kwargs):
        """Start in the state Straight, without a clearance."""
        super().__init__('navigation_controller', **kwargs)
        for parameter in PARAMETERS:
            declare(self, *parameter)
        self.newest, self.state, self.may_move = None, Straight(), True
        self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Clearance, 'clearance', self.receive, 10)
        self.create_service(SetBool, 'enable', self.enable)
        self.create_timer(0.1, lambda: self.commands.publish(self.command()))

    def receive(self, clearance):
        """Remember the newest clearance."""
        self.newest = clearance

    def enable(self, request, response):
        """Let the robot move, or hold it still."""
        self.may_move = bool(request.data)
        response.success = True
        return response

    def is_clearance_trusted(self):
        """Return whether the newest clearance is valid and not too old."""
        if self.newest is None or not self.newest.valid:
            return False
        scan_time = Time.from_msg(self.newest.header.stamp)
        age = (self.get_clock().now() - scan_time).nanoseconds / 1e9
        return age <= self.get_parameter('data_timeout').value

    def command(self):
        """Return the command of this moment."""
        if not (self.may_move and self.is_clearance_trusted()):
            return Twist()
        limit = self.get_parameter('safety_distance').value
        self.state = self.state.next(self.newest, limit)
        if self.state.side:
            turn = self.state.side * self.get_parameter('turn_speed').value
            return Twist(angular=Vector3(z=turn))
        return Twist(linear=Vector3(x=self.get_parameter('forward_speed').value))


def main(args=None):
    """Run the node until it is told to stop."""
    run(NavigationController, args)
