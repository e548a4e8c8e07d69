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

"""Ten times a second, say how fast to drive and to turn."""

from geometry_msgs.msg import Twist, Vector3
from rclpy.node import Node
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.steering import choose_turn, STRAIGHT

PARAMETERS = {  # name: default, lowest, highest, description
    'data_timeout': (0.5, 0.2, 2.0, 'How old a clearance may be, in seconds'),
    'safety_distance': (0.6, 0.3, 2.0, 'How near a thing ahead may be, in metres'),
    'turn_speed': (0.8, 0.1, 1.5, 'How fast to turn, in radians per second'),
    'forward_speed': (0.3, 0.05, 0.5, 'How fast to drive, in metres per second'),
}


class NavigationController(Node):
    """Commands the wheels by the newest clearance."""

    def __init__(self, **kwargs):
        """Create the node, its parameters, topics, service and timer."""
        super().__init__('navigation_controller', **kwargs)
        for name, details in PARAMETERS.items():
            declare(self, name, *details)
        self.enabled = True
        self.turn = STRAIGHT
        self.clearance = None
        self.service = self.create_service(SetBool, 'enable', self.enable_callback)
        self.subscription = self.create_subscription(
            Clearance, 'clearance', self.clearance_callback, 10)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(0.1, self.control)

    def _number(self, name):
        """Return a parameter's value of this moment."""
        return self.get_parameter(name).get_parameter_value().double_value

    def clearance_callback(self, clearance):
        """Keep it."""
        self.clearance = clearance

    def enable_callback(self, request, response):
        """Do as requested."""
        self.enabled = request.data
        response.success, response.message = True, f'enabled: {request.data}'
        return response

    def control(self):
        """Publish what _decide says."""
        speed, rate = self._decide()
        self.publisher.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=rate)))

    def _decide(self):
        """Return the speed and the turn rate of this moment."""
        if self._is_blind() or not self.enabled:
            return 0.0, 0.0
        self.turn = choose_turn(self.clearance, self._number('safety_distance'), self.turn)
        if self.turn == STRAIGHT:
            return self._number('forward_speed'), 0.0
        return 0.0, self.turn * self._number('turn_speed')

    def _is_blind(self):
        """Say whether there is nothing to rely on."""
        if self.clearance is None or not self.clearance.valid:
            return True
        then = Time.from_msg(self.clearance.header.stamp).nanoseconds
        return self.get_clock().now().nanoseconds - then > 1e9 * self._number('data_timeout')


def main(args=None):
    """Run the node until it is told to stop."""
    run(NavigationController, args)


if __name__ == '__main__':
    main()
