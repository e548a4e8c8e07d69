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

"""Drive at a steady speed and turn at a steady rate: a circle, or a straight line."""

from geometry_msgs.msg import Twist
from rcl_interfaces.msg import ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

PERIOD = 0.1  # s: 10 commands a second


class Driver(Node):
    """Publishes cmd_vel (geometry_msgs/Twist). Both parameters are read once, at the start."""

    def __init__(self):
        super().__init__('driver')
        self.command = Twist()
        self.command.linear.x = self.parameter('speed', 0.1, 'forward speed, in m/s')
        self.command.angular.z = self.parameter('turn_rate', 0.0, 'turning rate, in rad/s')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_timer(PERIOD, lambda: self.publisher.publish(self.command))
        self.get_logger().info(f'Driving at {self.command.linear.x:g} m/s')

    def parameter(self, name, default, description):
        """Declare a parameter that only a launch file or a command line sets; return its value."""
        descriptor = ParameterDescriptor(description=description, read_only=True)
        return self.declare_parameter(name, default, descriptor).value


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = Driver()
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
