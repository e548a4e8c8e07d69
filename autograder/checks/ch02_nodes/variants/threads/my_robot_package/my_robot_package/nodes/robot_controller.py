"""A robot controller that receives messages and publishes commands in separate threads."""

import math
from threading import Lock

from geometry_msgs.msg import Twist
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1
FORWARD_SPEED = 0.3
TURN_RATE = 0.5
SAFETY_DISTANCE = 1.0
HALF_SECTOR = math.radians(30.0)
SCAN_TIMEOUT = Duration(seconds=0.5)


def forward_clearance(scan):
    """Return the smallest usable reading in front (it may be inf or -inf), or None."""
    nearest = None
    for index, reading in enumerate(scan.ranges):
        bearing = math.remainder(scan.angle_min + index * scan.angle_increment, math.tau)
        if not -HALF_SECTOR <= bearing <= HALF_SECTOR:
            continue
        if math.isfinite(reading) and not scan.range_min <= reading <= scan.range_max:
            continue
        if math.isnan(reading):
            continue
        if nearest is None or reading < nearest:
            nearest = reading
    return nearest


class RobotController(Node):
    """Turn the newest lidar scan into a velocity command, ten times a second."""

    def __init__(self, **kwargs):
        super().__init__('robot_controller', **kwargs)
        self.lock = Lock()
        self.newest = (None, None)
        inputs, control = ReentrantCallbackGroup(), MutuallyExclusiveCallbackGroup()
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', qos_profile=10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data, callback_group=inputs)
        self.create_subscription(
            String, 'status', self.status_callback, 10, callback_group=inputs)
        self.create_timer(CONTROL_PERIOD, self.control_loop, callback_group=control)

    def scan_callback(self, msg):
        """Keep the scan with its time of arrival."""
        now = self.get_clock().now()
        with self.lock:
            self.newest = (msg, now)

    def status_callback(self, msg):
        """Log the status."""
        self.get_logger().info(f'The status is now: {msg.data}')

    def control_loop(self):
        """Publish one command."""
        clearance = self.current_clearance()
        command = Twist()
        if clearance is not None and clearance >= SAFETY_DISTANCE:
            command.linear.x = FORWARD_SPEED
        elif clearance is not None:
            command.angular.z = TURN_RATE
            self.get_logger().warning('Obstacle!', throttle_duration_sec=1.0)
        self.cmd_vel_pub.publish(command)

    def current_clearance(self):
        """Return the current clearance, or None without a fresh scan."""
        with self.lock:
            scan, arrived = self.newest
        if scan is None or self.get_clock().now() - arrived > SCAN_TIMEOUT:
            return None
        return forward_clearance(scan)


def main(args=None):
    """Run the node on two threads until Ctrl-C or SIGTERM."""
    rclpy.init(args=args)
    node, executor = None, MultiThreadedExecutor(num_threads=2)
    try:
        node = RobotController()
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        executor.shutdown()
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
