"""The node that turns scans into clearances."""

import math

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT

SECTORS = {'front': FRONT, 'left': LEFT, 'right': RIGHT}


class SensorProcessor(Node):
    """Publishes one clearance for each scan."""

    def __init__(self, **kwargs):
        """Create the node."""
        super().__init__('sensor_processor', **kwargs)
        declare(self, 'half_angle', 0.52, 0.1, 0.78, 'half the width of a sector in rad')
        self.publisher = self.create_publisher(Clearance, 'clearance', 10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)

    def scan_callback(self, scan):
        """Publish the clearance of a scan."""
        half_angle = self.get_parameter('half_angle').value
        distances = {name: nearest(scan, middle, half_angle) for name, middle in SECTORS.items()}
        valid = not any(map(math.isnan, distances.values()))
        self.publisher.publish(Clearance(header=scan.header, valid=valid, **distances))


def main(args=None):
    """Run the node until it is told to stop."""
    run(SensorProcessor, args)


if __name__ == '__main__':
    main()
