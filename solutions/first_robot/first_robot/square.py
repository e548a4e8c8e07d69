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


"""Drive along the sides of a square, by the clock alone."""

import math

from geometry_msgs.msg import Twist
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

SPEED = 0.3  # m/s
SIDE_SECONDS = 4.0  # s: a side is 1.2 m
TURN_SECONDS = 2.0  # s
TURN_RATE = math.radians(90.0) / TURN_SECONDS  # rad/s, positive is to the left


def command_at(seconds):
    """
    Return (linear, angular): what the robot does this many seconds after its start.

    The robot drives straight on at SPEED for SIDE_SECONDS, then turns on the spot at TURN_RATE
    for TURN_SECONDS, and repeats this for ever. At exactly SIDE_SECONDS, it is already turning.
    linear is in m/s, angular in rad/s.
    """
    within = seconds % (SIDE_SECONDS + TURN_SECONDS)
    if within < SIDE_SECONDS:
        return SPEED, 0.0
    return 0.0, TURN_RATE


class Square(Node):
    """Ask command_at ten times a second what to publish on cmd_vel."""

    def __init__(self):
        """Create the publisher and the timer, and remember the start."""
        super().__init__('square')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.start = self.get_clock().now()
        self.create_timer(0.1, self.drive)

    def drive(self):
        """Publish one command."""
        elapsed = self.get_clock().now() - self.start
        command = Twist()
        command.linear.x, command.angular.z = command_at(elapsed.nanoseconds / 1e9)
        self.publisher.publish(command)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = Square()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():  # if not, a signal came between two waits, and rclpy raised this
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
