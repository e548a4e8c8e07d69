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

"""Look at the robot's battery once; the exit status says whether the robot may drive."""

import sys

from rcl_interfaces.msg import ParameterDescriptor
import rclpy
from rclpy.node import Node

ENOUGH = 20.0  # percent


class SelfTest(Node):
    """Has one parameter, battery: the charge that it finds, in percent."""

    def __init__(self):
        super().__init__('self_test')
        descriptor = ParameterDescriptor(description='charge of the battery, in percent')
        self.battery = self.declare_parameter('battery', 100.0, descriptor).value

    def passes(self):
        """Log what was found; return whether it is enough."""
        found = f'Battery at {self.battery:g} %, {ENOUGH:g} % needed'
        if self.battery < ENOUGH:
            self.get_logger().error(found)
        else:
            self.get_logger().info(found)
        return self.battery >= ENOUGH


def main(args=None):
    """Run the test; return the exit status: 0 for a robot that may drive, 1 for others."""
    rclpy.init(args=args)
    try:
        node = SelfTest()
        passed = node.passes()
        node.destroy_node()
        return 0 if passed else 1
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    sys.exit(main())
