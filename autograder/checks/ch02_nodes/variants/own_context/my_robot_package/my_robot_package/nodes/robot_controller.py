"""A pilot that knows no ROS, and a node around it; signals are this program's own affair."""

import collections
import math
import signal
import threading

from geometry_msgs.msg import Twist, Vector3
import rclpy
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

COS_30 = math.sqrt(3.0) / 2.0
Seen = collections.namedtuple('Seen', 'scan when')


def counting(scan):
    """Yield each forward reading that counts."""
    low, high = scan.range_min, scan.range_max
    bearing = scan.angle_min
    for i, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + i * scan.angle_increment
        if math.cos(bearing) > COS_30 and (math.isinf(reading) or low <= reading <= high):
            yield reading


def forward_clearance(scan):
    """Return the smallest forward reading that counts, or None."""
    return min(counting(scan), default=None)


def pilot(clearance):
    """Return speed and rate."""
    if clearance is None:
        return 0.0, 0.0
    return (0.0, 0.5) if clearance < 1.0 else (0.3, 0.0)


class RobotController(Node):
    """Everything happens in the timer; callbacks only put things on shelves."""

    def __init__(self, **kwargs):
        super().__init__('robot_controller', **kwargs)
        self.seen = collections.deque(maxlen=1)
        self.safety = self.get_logger().get_child('safety')
        reliable = QoSProfile(
            history=HistoryPolicy.KEEP_LAST, depth=10, reliability=ReliabilityPolicy.RELIABLE)
        self.cmd_vel = self.create_publisher(Twist, 'cmd_vel', reliable)
        self.subs = [
            self.create_subscription(LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data),
            self.create_subscription(String, 'status', self.status_callback, reliable),
        ]
        self.beat = self.create_timer(0.1, self.control_loop)

    def scan_callback(self, msg):
        self.seen.append(Seen(msg, self.get_clock().now()))

    def status_callback(self, msg):
        self.get_logger().info(msg.data)

    def current_clearance(self):
        for scan, when in self.seen:
            if self.get_clock().now() - when <= Duration(nanoseconds=500_000_000):
                return forward_clearance(scan)
        return None

    def control_loop(self):
        clearance = self.current_clearance()
        if clearance is not None and clearance < 1.0:
            self.safety.warning('Turning away', throttle_duration_sec=1.2)
        speed, rate = pilot(clearance)
        self.cmd_vel.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=rate)))


def main(args=None):
    """Spin until one of the two signals sets the event."""
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    context = rclpy.Context()
    context.init(args)
    try:
        node = RobotController(context=context)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        while not ended.is_set():
            executor.spin_once(timeout_sec=0.2)
        executor.shutdown()
        node.destroy_node()
    finally:
        context.try_shutdown()


if __name__ == '__main__':
    main()
