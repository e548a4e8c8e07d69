"""The sensor processor without a class, with a multi-threaded executor."""

from functools import partial

from my_robot_package.utils.data_processing import DataProcessor, mean_distance
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32

BEST_EFFORT = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def publish_masked(node, processor, scans, means, msg):
    """Publish the masked scan and the mean."""
    msg.ranges = processor.process(list(msg.ranges), msg.range_min, msg.range_max)
    scans.publish(msg)
    if mean_distance(msg.ranges) is not None:
        average = Float32()
        average.data = processor.average()
        means.publish(average)
        return
    node.get_logger().warning("blind", throttle_duration_sec=1.0)


def main(args=None):
    """Create the node, and spin it with several threads."""
    rclpy.init(args=args)
    try:
        node = rclpy.create_node("sensor_processor")
        scans = node.create_publisher(LaserScan, "scan_filtered", BEST_EFFORT)
        means = node.create_publisher(Float32, "mean_distance", 10)
        node.create_subscription(
            LaserScan,
            "scan",
            partial(publish_masked, node, DataProcessor(10), scans, means),
            BEST_EFFORT,
            callback_group=ReentrantCallbackGroup(),
        )
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
