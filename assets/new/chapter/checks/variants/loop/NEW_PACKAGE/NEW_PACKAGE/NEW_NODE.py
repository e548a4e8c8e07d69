"""A correct answer in another style: no function, one loop, and a callback defined in __init__."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class Watch(Node):
    def __init__(self):
        super().__init__('NEW_NODE')
        publisher = self.create_publisher(Float32, 'nearest', 10)

        def on_scan(scan):
            best = None
            for reading in scan.ranges:
                if reading < scan.range_min or reading > scan.range_max or reading != reading:
                    continue
                if best is None or reading < best:
                    best = reading
            if best is not None:
                publisher.publish(Float32(data=best))

        self.create_subscription(LaserScan, 'scan', on_scan, qos_profile_sensor_data)


def main():
    rclpy.init()
    try:
        rclpy.spin(Watch())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
