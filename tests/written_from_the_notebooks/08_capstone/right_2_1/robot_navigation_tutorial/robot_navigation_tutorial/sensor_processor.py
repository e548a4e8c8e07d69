"""Node sensor_processor: how much room there is on three sides."""

import math

from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance
from sensor_msgs.msg import LaserScan

from robot_navigation_tutorial import sectors
from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

SIDES = {'front': sectors.FRONT, 'left': sectors.LEFT, 'right': sectors.RIGHT}


class SensorProcessor(Node):
    """Answers each scan with a clearance."""

    def __init__(self, **kwargs) -> None:
        """Set the node up; kwargs are those of Node."""
        super().__init__('sensor_processor', **kwargs)
        declare(self, 'half_angle', 0.52, 0.1, 0.78, 'half the width of a sector, rad')
        self.publisher = self.create_publisher(Clearance, 'clearance', 10)
        self.subscription = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)

    def scan_callback(self, scan: LaserScan) -> None:
        """Turn one scan into one clearance."""
        half_angle = self.get_parameter('half_angle').value
        clearance = Clearance()
        clearance.header = scan.header
        clearance.valid = True
        for side, middle in SIDES.items():
            distance = sectors.nearest(scan, middle, half_angle)
            setattr(clearance, side, distance)
            if math.isnan(distance):
                clearance.valid = False
        self.publisher.publish(clearance)


def main(args=None) -> None:
    """Start the program."""
    run(SensorProcessor, args)


if __name__ == '__main__':
    main()
