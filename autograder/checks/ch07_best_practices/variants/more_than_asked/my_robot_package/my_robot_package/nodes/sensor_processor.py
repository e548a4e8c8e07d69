"""Masks scans, and publishes them and their mean distance."""

from copy import deepcopy

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String

from my_robot_package.nodes.common import run_node
from my_robot_package.utils.data_processing import DataProcessor, mean_distance


class SensorProcessor(Node):
    """A node that masks scans."""

    def __init__(self, **kwargs):
        """Create the endpoints, with a callback group for the subscription."""
        super().__init__('sensor_processor', **kwargs)
        self.means = DataProcessor(history=10)
        self.next_warning = None
        self.filtered = self.create_publisher(LaserScan, 'scan_filtered', qos_profile_sensor_data)
        self.mean = self.create_publisher(Float32, 'mean_distance', 10)
        self.create_subscription(
            LaserScan, 'scan', self.on_scan, qos_profile_sensor_data,
            callback_group=MutuallyExclusiveCallbackGroup())
        self.declare_parameter('frame', 'laser')
        self.nearest = self.create_publisher(Float32, 'nearest', 10)
        self.summary = self.create_publisher(String, 'summary', 10)
        self.count = 0
        self.create_timer(0.7, lambda: self.get_logger().info(f'{self.count} scans so far'))
        self.get_logger().warning('ready to clean scans')

    def on_scan(self, scan):
        """Publish the masked scan and its numbers."""
        self.count += 1
        out = deepcopy(scan)
        out.ranges = self.means.process(scan.ranges, scan.range_min, scan.range_max)
        if mean_distance(out.ranges) is None:
            self.warn()
        else:
            self.mean.publish(Float32(data=self.means.average()))
            self.nearest.publish(Float32(data=min(r for r in out.ranges if abs(r) < 1e9)))
            self.summary.publish(String(data=f'{len(out.ranges)} beams'))
        self.filtered.publish(out)

    def warn(self):
        """Warn, unless the last warning was less than a second ago."""
        now = self.get_clock().now()
        if self.next_warning is None or now >= self.next_warning:
            self.next_warning = now + Duration(seconds=1.0)
            self.get_logger().warning('this scan has no finite distance at all: no mean')


def main(args=None):
    """Run the node until it is interrupted."""
    run_node(SensorProcessor, args)


if __name__ == '__main__':
    main()
