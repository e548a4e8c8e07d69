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

"""Say now and then how a robot moves, so that somebody else can listen."""

from geometry_msgs.msg import Twist
from rcl_interfaces.msg import ParameterDescriptor
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Reporter(Node):
    """
    Turns commands into sentences.

    Subscribes to cmd_vel (geometry_msgs/Twist), publishes status (std_msgs/String). Both
    parameters are read once, at the start.
    """

    def __init__(self):
        super().__init__('reporter')
        self.robot_name = self.parameter('robot_name', 'nobody', 'who is speaking')
        period = self.parameter('report_period', 1.0, 'time between two reports, in seconds')
        self.command = None
        self.publisher = self.create_publisher(String, 'status', 10)
        self.create_subscription(Twist, 'cmd_vel', self.command_callback, 10)
        self.create_timer(period, self.report)
        self.get_logger().info(f'Reporting for {self.robot_name}')

    def parameter(self, name, default, description):
        """Declare a parameter that only a launch file or a command line sets; return its value."""
        descriptor = ParameterDescriptor(description=description, read_only=True)
        return self.declare_parameter(name, default, descriptor).value

    def command_callback(self, msg):
        """Keep the newest command."""
        self.command = msg

    def report(self):
        """Publish one sentence."""
        if self.command is None:
            doing = 'waits for a command'
        else:
            doing = f'drives at {self.command.linear.x:.2f} m/s'
        self.publisher.publish(String(data=f'{self.robot_name} {doing}'))


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = Reporter()
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
