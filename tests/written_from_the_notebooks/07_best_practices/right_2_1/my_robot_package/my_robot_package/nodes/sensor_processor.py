"""Node sensor_processor: scan in; scan_filtered and mean_distance out."""

from copy import deepcopy
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

from my_robot_package.utils.data_processing import DataProcessor, mean_distance


class SensorProcessor(Node):
    """Gives each scan on without its phantoms, and says how far away things are."""

    def __init__(self, **kwargs) -> None:
        super().__init__('sensor_processor', **kwargs)
        self.processor = DataProcessor(history=10)
        self.filtered_pub = self.create_publisher(
            LaserScan, 'scan_filtered', qos_profile_sensor_data)
        self.mean_pub = self.create_publisher(Float32, 'mean_distance', 10)
        self.scan_sub = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self._warned_at = None  # s, of the computer's own clock, which never jumps

    def scan_callback(self, msg: LaserScan) -> None:
        """Handle one scan."""
        clean = deepcopy(msg)
        clean.ranges = self.processor.process(msg.ranges, msg.range_min, msg.range_max)
        self.filtered_pub.publish(clean)
        if mean_distance(clean.ranges) is not None:
            mean = Float32()
            mean.data = self.processor.average()
            self.mean_pub.publish(mean)
            return
        self._warn()

    def _warn(self) -> None:
        """Say that a scan was blind, unless that was said less than a second ago."""
        now = time.monotonic()
        if self._warned_at is not None and now - self._warned_at < 1.0:
            return
        self._warned_at = now
        self.get_logger().warning('The scan holds no distance')


def main(args=None) -> None:
    """Spin the node until a signal ends it."""
    rclpy.init(args=args)
    try:
        node = SensorProcessor()
        try:
            rclpy.spin(node)
        finally:
            node.destroy_node()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
