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


"""Drive in a circle, for ever."""

from geometry_msgs.msg import Twist
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

SPEED = 0.3  # m/s
TURN_RATE = 0.5  # rad/s, positive is to the left


class Circle(Node):
    """Publish the same velocity on cmd_vel ten times a second."""

    def __init__(self):
        """Create the publisher and the timer."""
        super().__init__('circle')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(0.1, self.drive)

    def drive(self):
        """Publish one command."""
        command = Twist()
        command.linear.x = SPEED
        command.angular.z = TURN_RATE
        self.publisher.publish(command)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = Circle()
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
