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


"""Drive a square, over and over."""

from geometry_msgs.msg import Twist
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from square_dance.utils.steps import step_at

PERIOD = 0.1  # s: 10 commands a second


class Dancer(Node):
    """Publish cmd_vel (geometry_msgs/Twist); the parameter side is the square's, in metres."""

    def __init__(self, **kwargs):
        super().__init__('dancer', **kwargs)
        self.side = self.declare_parameter('side', 1.0).value
        self.began = None
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(PERIOD, self.dance)
        self.get_logger().info(f'Dancing a square of {self.side:g} m')

    def dance(self):
        """Publish the step that is due now."""
        now = self.get_clock().now()
        if self.began is None:
            self.began = now
        command = Twist()
        command.linear.x, command.angular.z = step_at(
            (now - self.began).nanoseconds * 1e-9, self.side)
        self.cmd_vel_pub.publish(command)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = Dancer()
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
