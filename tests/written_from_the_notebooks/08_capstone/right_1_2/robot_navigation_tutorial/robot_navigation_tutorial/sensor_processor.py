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

"""The node between the lidar and the rest."""

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT


def clearance_of(scan, half_angle):
    """Return the clearance that a scan shows."""
    front = nearest(scan, FRONT, half_angle)
    left = nearest(scan, LEFT, half_angle)
    right = nearest(scan, RIGHT, half_angle)
    valid = front == front and left == left and right == right  # nan is not equal to itself
    return Clearance(header=scan.header, valid=valid, front=front, left=left, right=right)


class SensorProcessor(Node):
    """Listens to scan, says clearance."""

    def __init__(self, **kwargs):
        """Name it; make its ends."""
        super().__init__('sensor_processor', **kwargs)
        declare(self, 'half_angle', 0.52, 0.1, 0.78, 'Sectors: from -half_angle to +half_angle')
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile=qos_profile_sensor_data)
        self.publisher = self.create_publisher(Clearance, 'clearance', 10)

    def scan_callback(self, scan):
        """Pass it on as a clearance."""
        (half_angle,) = self.get_parameters(['half_angle'])
        self.publisher.publish(clearance_of(scan, half_angle.value))


def main(args=None):
    """Run the node until it is told to stop."""
    run(SensorProcessor, args)


if __name__ == '__main__':
    main()
