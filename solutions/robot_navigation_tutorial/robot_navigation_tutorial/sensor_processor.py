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

"""The node that sees: from a laser scan to the clearance ahead, to the left, to the right."""

import math

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT


class SensorProcessor(Node):
    """
    Publishes one clearance for each scan.

    Subscribes to scan (sensor_msgs/LaserScan), publishes clearance
    (robot_navigation_interfaces/Clearance).
    """

    def __init__(self, **kwargs):
        """
        Name the node sensor_processor; declare its parameter, create its topics.

        half_angle: 0.52 rad, from 0.1 to 0.78. scan: qos_profile_sensor_data.
        clearance: a queue of 10. kwargs are passed on to Node.
        """
        super().__init__('sensor_processor', **kwargs)
        declare(self, 'half_angle', 0.52, 0.1, 0.78,
                'rad: how far a sector reaches to each side of its middle')
        self.publisher = self.create_publisher(Clearance, 'clearance', 10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)

    def scan_callback(self, scan):
        """
        Publish the scan's clearance, with the scan's own header.

        front, left, right: the nearest thing within half_angle of each sector's middle.
        valid: none of the three is nan.
        """
        half_angle = self.get_parameter('half_angle').value
        front, left, right = (
            nearest(scan, middle, half_angle) for middle in (FRONT, LEFT, RIGHT))
        valid = not any(math.isnan(distance) for distance in (front, left, right))
        self.publisher.publish(Clearance(
            header=scan.header, valid=valid, front=front, left=left, right=right))


def main(args=None):
    """Run the node until it is told to stop."""
    run(SensorProcessor, args)


if __name__ == '__main__':
    main()
