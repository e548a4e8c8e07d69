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

"""Turn each scan into a clearance."""

from math import isnan

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial import sectors
from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

FIELDS = {'front': sectors.FRONT, 'left': sectors.LEFT, 'right': sectors.RIGHT}


class SensorProcessor(Node):
    """One clearance for one scan."""

    def __init__(self, **kwargs):
        """Create the node, its parameter and its topics."""
        super().__init__('sensor_processor', **kwargs)
        declare(self, name='half_angle', default=0.52, lowest=0.1, highest=0.78,
                description='Half the width of each sector, in radians')
        self.publisher = self.create_publisher(Clearance, 'clearance', 10)
        self.subscription = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)

    def scan_callback(self, scan):
        """Look into each sector, and publish what is there."""
        clearance = Clearance(header=scan.header, valid=True)
        for field, middle in FIELDS.items():
            distance = sectors.nearest(scan, middle, self.get_parameter('half_angle').value)
            setattr(clearance, field, distance)
            if isnan(distance):
                clearance.valid = False
        self.publisher.publish(clearance)


def main(args=None):
    """Run the node until it is told to stop."""
    run(SensorProcessor, args)


if __name__ == '__main__':
    main()
