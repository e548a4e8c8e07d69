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

"""The eyes: scans become clearances."""

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT


def to_clearance(scan, half_angle):
    """Return the clearance of a scan."""
    distances = [nearest(scan, middle, half_angle) for middle in (FRONT, LEFT, RIGHT)]
    front, left, right = distances
    return Clearance(
        header=scan.header,
        valid=all(distance == distance for distance in distances),  # a nan is not equal to itself
        front=front,
        left=left,
        right=right,
    )


class SensorProcessor(Node):
    """Publishes on clearance what it sees on scan."""

    def __init__(self, **kwargs):
        """Hand kwargs to Node."""
        super().__init__('sensor_processor', **kwargs)
        declare(
            node=self, name='half_angle', default=0.52, lowest=0.1, highest=0.78,
            description='from the middle of a sector to its edge (rad)')
        self.publisher = self.create_publisher(Clearance, 'clearance', 10)
        self.create_subscription(LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.get_logger().info('I see')

    def scan_callback(self, scan):
        """Publish a clearance."""
        self.publisher.publish(to_clearance(scan, self.get_parameter('half_angle').value))


def main(args=None):
    """Be an executable."""
    run(SensorProcessor, args)


if __name__ == '__main__':
    main()
