"""Publish the distance to the nearest obstacle."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


def nearest(scan):
    """Return the smallest reading of a scan that counts, or None if none does."""

    def counts(reading):
        return scan.range_min <= reading <= scan.range_max

    return min(filter(counts, scan.ranges), default=None)


class NEW_CLASS(Node):
    """Publishes the distance to the nearest obstacle."""

    def __init__(self):
        super().__init__('NEW_NODE')
        self.publisher = self.create_publisher(Float32, 'nearest', 10)
        self.create_subscription(LaserScan, 'scan', self.on_scan, qos_profile_sensor_data)

    def on_scan(self, scan):
        """Publish the nearest reading of each scan, and nothing if no reading counts."""
        reading = nearest(scan)
        if reading is not None:
            self.publisher.publish(Float32(data=reading))


def main(args=None):
    """Run the node until it is stopped."""
    rclpy.init(args=args)
    node = NEW_CLASS()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
