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

"""A controller of closures: callbacks share the newest clearance behind a lock."""

import threading

from geometry_msgs.msg import Twist
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.time import Time
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.steering import pilot


def build():
    """Return the node; each callback has its own callback group."""
    node = rclpy.create_node('navigation_controller')
    declare(node, 'data_timeout', 0.5, 0.2, 2.0, 'how long a clearance holds, in s')
    declare(node, 'forward_speed', 0.3, 0.05, 0.5, 'how fast it drives, in m/s')
    declare(node, 'safety_distance', 0.6, 0.3, 2.0, 'how near it comes, in m')
    declare(node, 'turn_speed', 0.8, 0.1, 1.5, 'how fast it turns, in rad/s')
    lock, decide = threading.Lock(), pilot()
    enabled, newest = threading.Event(), []
    enabled.set()
    commands = node.create_publisher(Twist, 'cmd_vel', 10)

    def value(name):
        return node.get_parameter(name).value

    def receive(clearance):
        with lock:
            newest[:] = [clearance]

    def enable_callback(request, response):
        (enabled.set if request.data else enabled.clear)()
        response.success, response.message = True, str(request.data)
        return response

    def trusted_clearance():
        with lock:
            clearance = newest[0] if newest else None
        if clearance is None or not clearance.valid:
            return None
        expires = Time.from_msg(clearance.header.stamp) + Duration(seconds=value('data_timeout'))
        return None if node.get_clock().now() > expires else clearance

    def control():
        command, clearance = Twist(), trusted_clearance()
        if enabled.is_set() and clearance is not None:
            side = decide(
                clearance.front, clearance.left, clearance.right, value('safety_distance'))
            if side == 0:
                command.linear.x = value('forward_speed')
            else:
                command.angular.z = side * value('turn_speed')
        commands.publish(command)

    group = MutuallyExclusiveCallbackGroup
    node.create_subscription(Clearance, 'clearance', receive, 10, callback_group=group())
    node.create_service(SetBool, 'enable', enable_callback, callback_group=group())
    node.create_timer(0.1, control, callback_group=group())
    return node


def main(args=None):
    """Spin the node in three threads."""
    rclpy.init(args=args)
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(build())
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
