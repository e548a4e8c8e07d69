"""A node around a pilot function without ROS; the program handles its signals itself."""

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
StampedScan = collections.namedtuple('StampedScan', 'scan arrival')


def valid_readings(scan):
    """Yield each forward reading that counts."""
    low, high = scan.range_min, scan.range_max
    bearing = scan.angle_min
    for i, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + i * scan.angle_increment
        if math.cos(bearing) > COS_30 and (math.isinf(reading) or low <= reading <= high):
            yield reading


def forward_clearance(scan):
    """Return the smallest forward reading that counts, or None."""
    return min(valid_readings(scan), default=None)


def pilot(clearance):
    """Return the speed and the turn rate for a clearance."""
    if clearance is None:
        return 0.0, 0.0
    return (0.0, 0.5) if clearance < 1.0 else (0.3, 0.0)


class RobotController(Node):
    """Decide in the timer; callbacks only store messages."""

    def __init__(self, **kwargs):
        super().__init__('robot_controller', **kwargs)
        self.scans = collections.deque(maxlen=1)
        self.safety = self.get_logger().get_child('safety')
        reliable = QoSProfile(
            history=HistoryPolicy.KEEP_LAST, depth=10, reliability=ReliabilityPolicy.RELIABLE)
        self.cmd_vel = self.create_publisher(Twist, 'cmd_vel', reliable)
        self.subs = [
            self.create_subscription(LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data),
            self.create_subscription(String, 'status', self.status_callback, reliable),
        ]
        self.timer = self.create_timer(0.1, self.control_loop)

    def scan_callback(self, msg):
        self.scans.append(StampedScan(msg, self.get_clock().now()))

    def status_callback(self, msg):
        self.get_logger().info(msg.data)

    def current_clearance(self):
        for scan, arrival in self.scans:
            if self.get_clock().now() - arrival <= Duration(nanoseconds=500_000_000):
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
    stop_event = threading.Event()
    for signum in (signal.SIGINT, signal.SIGTERM):
        signal.signal(signum, lambda *_: stop_event.set())
    context = rclpy.Context()
    context.init(args)
    try:
        node = RobotController(context=context)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        while not stop_event.is_set():
            executor.spin_once(timeout_sec=0.2)
        executor.shutdown()
        node.destroy_node()
    finally:
        context.try_shutdown()


if __name__ == '__main__':
    main()
