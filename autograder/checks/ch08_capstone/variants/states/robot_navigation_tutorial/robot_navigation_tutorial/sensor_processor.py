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

"""A processor that uses a node, instead of being one."""

import math

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT

SECTORS = {'front': FRONT, 'left': LEFT, 'right': RIGHT}


class Processor:
    """Turns scans into clearances."""

    def __init__(self, node):
        """Create the publisher and the subscription on the node."""
        self.half_angle = lambda: node.get_parameter('half_angle').value
        self.publish = node.create_publisher(Clearance, 'clearance', 10).publish
        node.create_subscription(LaserScan, 'scan', self.receive, qos_profile_sensor_data)

    def receive(self, scan):
        """Publish the clearance of a scan."""
        distances = {
            name: nearest(scan, middle, self.half_angle()) for name, middle in SECTORS.items()}
        is_known = all(not math.isnan(distance) for distance in distances.values())
        self.publish(Clearance(header=scan.header, valid=is_known, **distances))


def make(**kwargs):
    """Return the node, with a processor that uses it."""
    node = Node('sensor_processor', **kwargs)
    declare(node, 'half_angle', 0.52, 0.1, 0.78, 'rad, half of what a sector spans')
    node.processor = Processor(node)
    return node


def main(args=None):
    """Run the node until it is told to stop."""
    run(make, args)


if __name__ == '__main__':
    rclpy.logging.get_logger('sensor_processor').info('started by hand')
    main()
