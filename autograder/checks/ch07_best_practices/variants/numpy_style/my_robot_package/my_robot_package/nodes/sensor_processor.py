"""The sensor processor as closures in main, which publish copies of scans."""

from copy import deepcopy

from my_robot_package.utils.data_processing import DataProcessor, mean_distance
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

LIDAR = QoSProfile(reliability=ReliabilityPolicy.BEST_EFFORT, history=HistoryPolicy.KEEP_LAST, depth=5)


def main(args=None):
    """Create the node and its endpoints, and spin."""
    rclpy.init(args=args)
    node = rclpy.create_node("sensor_processor")
    processor = DataProcessor(10)
    filtered = node.create_publisher(LaserScan, "scan_filtered", LIDAR)
    means = node.create_publisher(Float32, "mean_distance", 10)

    def on_scan(scan):
        masked = deepcopy(scan)
        masked.ranges = processor.process(scan.ranges, scan.range_min, scan.range_max)
        filtered.publish(masked)
        if mean_distance(masked.ranges) is not None:
            means.publish(Float32(data=processor.average()))
            return
        node.get_logger().warning("the lidar sees no distance at all", throttle_duration_sec=1.0)

    node.create_subscription(LaserScan, "scan", on_scan, LIDAR)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
