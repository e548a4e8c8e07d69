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

"""A controller that has a node, and runs in two threads."""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from robot_navigation_interfaces.msg import Clearance
from robot_navigation_tutorial.steering import Turn, decide
from std_srvs.srv import SetBool

PARAMETERS = {
    'forward_speed': (0.3, 0.05, 0.5, 'metres a second'),
    'turn_speed': (0.8, 0.1, 1.5, 'radians a second'),
    'safety_distance': (0.6, 0.3, 2.0, 'metres'),
    'data_timeout': (0.5, 0.2, 2.0, 'seconds'),
}


class Controller:
    """Holds a node, the newest clearance and the turn."""

    def __init__(self, node):
        self.node = node
        self.turn = Turn.NONE
        self.newest = None
        self.held = False
        for name, (default, lowest, highest, unit) in PARAMETERS.items():
            limits = FloatingPointRange(from_value=lowest, to_value=highest)
            node.declare_parameter(
                name, default, ParameterDescriptor(description=unit, floating_point_range=[limits])
            )
        self.publisher = node.create_publisher(Twist, 'cmd_vel', 10)
        node.create_subscription(
            Clearance, 'clearance', self.receive, 10, callback_group=ReentrantCallbackGroup()
        )
        node.create_service(SetBool, 'enable', self.hold)
        node.create_timer(0.1, self.tick, callback_group=MutuallyExclusiveCallbackGroup())

    def parameter(self, name):
        """Return the current value of a parameter."""
        return self.node.get_parameter(name).value

    def receive(self, clearance):
        """Remember the clearance, with the time of its scan in seconds."""
        stamp = clearance.header.stamp
        self.newest = (stamp.sec + stamp.nanosec * 1e-9, clearance)

    def hold(self, request, response):
        """Hold the robot still, or let it drive."""
        self.held = not request.data
        response.success, response.message = True, 'held' if self.held else 'free'
        return response

    def tick(self):
        """Publish the command of this moment."""
        self.publisher.publish(self.command())

    def command(self):
        """Return the command of this moment."""
        stop = Twist()
        if self.held or self.newest is None:
            return stop
        scan_time, clearance = self.newest
        now = self.node.get_clock().now().nanoseconds * 1e-9
        if not clearance.valid or now - scan_time > self.parameter('data_timeout'):
            return stop
        limit = self.parameter('safety_distance')
        self.turn = decide(clearance.front, clearance.left, clearance.right, limit, self.turn)
        command = Twist()
        if self.turn is Turn.NONE:
            # Slower in front of an obstacle: forward_speed is only the limit.
            is_near = clearance.front < limit + 0.2
            command.linear.x = self.parameter('forward_speed') * (0.5 if is_near else 1.0)
        else:
            command.angular.z = float(self.turn) * self.parameter('turn_speed')
        return command


def main():
    """Run the node until it is told to stop."""
    rclpy.init()
    try:
        node = rclpy.create_node('navigation_controller')
        controller = Controller(node)
        executor = MultiThreadedExecutor(num_threads=2)
        executor.add_node(controller.node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
