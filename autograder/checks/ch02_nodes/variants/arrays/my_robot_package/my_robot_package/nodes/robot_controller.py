"""A robot controller that evaluates all beams at once with numpy."""

from dataclasses import dataclass
import math

from geometry_msgs.msg import Twist, Vector3
import numpy as np
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1
FORWARD_SPEED = 0.3
TURN_RATE = 0.5
SAFETY_DISTANCE = 1.0
HALF_SECTOR = math.radians(30.0)
SCAN_TIMEOUT = Duration(seconds=0.5)


@dataclass(frozen=True)
class StampedScan:
    """A scan and its time of arrival."""

    scan: LaserScan
    arrival: Time


def forward_clearance(scan):
    """Return the smallest usable reading in front (it may be inf or -inf), or None."""
    readings = np.array(scan.ranges, dtype=np.float64)
    bearings = scan.angle_min + scan.angle_increment * np.arange(readings.size)
    off_axis = np.abs(np.angle(np.exp(1j * bearings)))
    with np.errstate(invalid='ignore'):
        measured = (readings >= scan.range_min) & (readings <= scan.range_max)
    usable = readings[(off_axis <= HALF_SECTOR) & (measured | np.isinf(readings))]
    return float(np.min(usable)) if usable.size else None


class RobotController(Node):
    """Turn the newest lidar scan into a velocity command, ten times a second."""

    def __init__(self, **kwargs):
        super().__init__('robot_controller', **kwargs)
        self._newest = None
        self._commands = self.create_publisher(Twist, 'cmd_vel', 10)
        self._inputs = [
            self.create_subscription(
                LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data),
            self.create_subscription(String, 'status', self.status_callback, 10),
        ]
        self._timer = self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg):
        """Keep the scan with its time of arrival."""
        self._newest = StampedScan(msg, self.get_clock().now())

    def status_callback(self, msg):
        """Log the status."""
        self.get_logger().info(msg.data)

    def control_loop(self):
        """Publish one command."""
        self._commands.publish(self._decide(self.current_clearance()))

    def current_clearance(self):
        """Return the current clearance, or None without a fresh scan."""
        if self._newest is None:
            return None
        age = self.get_clock().now() - self._newest.arrival
        return None if age > SCAN_TIMEOUT else forward_clearance(self._newest.scan)

    def _decide(self, clearance):
        if clearance is None:
            return Twist()
        if clearance < SAFETY_DISTANCE:
            self.get_logger().warning(
                f'{clearance:.2f} m in front: turning', throttle_duration_sec=1.0)
            return Twist(angular=Vector3(z=TURN_RATE))
        return Twist(linear=Vector3(x=FORWARD_SPEED))


def main(args=None):
    """Run the node until Ctrl-C or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
