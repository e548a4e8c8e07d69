"""The sensor processor with a worker thread, to which callbacks pass scans."""

import queue
import threading

from my_robot_package.utils.data_processing import DataProcessor, mean_distance
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class SensorProcessor(Node):
    """A node whose worker thread masks scans."""

    def __init__(self):
        """Create the endpoints, and start the worker."""
        super().__init__("sensor_processor")
        self.scans = queue.Queue()
        self.processor = DataProcessor(history=10)
        self.filtered = self.create_publisher(LaserScan, "scan_filtered", qos_profile_sensor_data)
        self.mean = self.create_publisher(Float32, "mean_distance", 10)
        self.create_subscription(LaserScan, "scan", self.scans.put, qos_profile_sensor_data)
        self.worker = threading.Thread(target=self.run_worker)
        self.worker.start()

    def run_worker(self):
        """Mask scans until the queue contains None."""
        while (scan := self.scans.get()) is not None:
            scan.ranges = self.processor.process(scan.ranges, scan.range_min, scan.range_max)
            self.filtered.publish(scan)
            if mean_distance(scan.ranges) is None:
                self.get_logger().warning("blind", throttle_duration_sec=1.0)
            else:
                self.mean.publish(Float32(data=self.processor.average()))

    def stop(self):
        """Stop the worker."""
        self.scans.put(None)
        self.worker.join()


def main():
    """Run the node until it is interrupted."""
    rclpy.init()
    node = SensorProcessor()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.stop()
        rclpy.try_shutdown()
