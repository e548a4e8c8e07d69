"""A robot controller whose constants are parameters."""

from functools import partial
import math
import sys

from geometry_msgs.msg import Twist
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String


def forward_clearance(scan):
    """Return the nearest forward distance, or None; a beam on the edge counts."""
    nearest = None
    for index in range(len(scan.ranges)):
        degrees = math.degrees(scan.angle_min + index * scan.angle_increment) % 360.0
        if 30.0001 < degrees < 329.9999:
            continue
        reading = scan.ranges[index]
        if reading != reading:
            continue
        if not math.isinf(reading) and (reading < scan.range_min or reading > scan.range_max):
            continue
        nearest = reading if nearest is None else min(nearest, reading)
    return nearest


class RobotController(Node):
    """Turn the newest lidar scan into a velocity command, ten times a second."""

    def __init__(self, **kwargs):
        kwargs.setdefault('enable_logger_service', True)
        super().__init__('robot_controller', **kwargs)
        self.declare_parameters('', [
            ('forward_speed', 0.3), ('turn_rate', 0.5), ('safety_distance', 1.0),
            ('scan_timeout', 0.5)])
        self.newest = {'scan': None, 'arrival': Time(clock_type=self.get_clock().clock_type)}
        self.create_timer(0.1, self.control_loop)
        self.create_subscription(String, 'status', self.status_callback, 10)
        self.create_subscription(
            LaserScan, 'scan', partial(RobotController.scan_callback, self), qos_profile_sensor_data)
        self.velocity = self.create_publisher(Twist, 'cmd_vel', qos_profile=10)
        self.turns = 0
        self.get_logger().debug('made')

    def read_number(self, name):
        return self.get_parameter(name).get_parameter_value().double_value

    def scan_callback(self, msg):
        self.newest = {'scan': msg, 'arrival': self.get_clock().now()}

    def status_callback(self, msg):
        self.get_logger().info('status of somebody:\n' + msg.data + '\n(end of status)')

    def current_clearance(self):
        scan = self.newest['scan']
        age = (self.get_clock().now() - self.newest['arrival']).nanoseconds / 1e9
        if scan is None or age > self.read_number('scan_timeout'):
            self.get_logger().debug('blind')
            return None
        return forward_clearance(scan)

    def control_loop(self):
        clearance = self.current_clearance()
        command = Twist()
        if clearance is None:
            self.get_logger().info('I see nothing, I stand', throttle_duration_sec=5.0)
        elif clearance < self.read_number('safety_distance'):
            command.angular.z = self.read_number('turn_rate')
            self.turns += 1
            self.get_logger().warn(
                f'obstacle, turning for the {self.turns}. time', throttle_duration_sec=1.0)
        else:
            command.linear.x = self.read_number('forward_speed')
        self.velocity.publish(command)


def spin(node):
    """Spin the node, one callback at a time."""
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=1.0)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args if args is not None else sys.argv)
    try:
        spin(RobotController())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
