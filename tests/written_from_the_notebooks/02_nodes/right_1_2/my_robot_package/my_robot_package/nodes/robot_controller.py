# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The controller, with all that it decides in functions that know nothing of ROS."""

from itertools import count
from math import atan2, cos, inf, radians, sin

from geometry_msgs.msg import Twist, Vector3
import rclpy
from rclpy.duration import Duration
import rclpy.executors
import rclpy.node
import rclpy.qos
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD, FORWARD_SPEED, TURN_RATE, SAFETY_DISTANCE = 0.1, 0.3, 0.5, 1.0
HALF_SECTOR = radians(30)
SCAN_TIMEOUT = Duration(seconds=0, nanoseconds=500_000_000)


def forward_clearance(scan):
    """Return the least of the forward readings that count by REP 117, or None."""
    bearings = (scan.angle_min + beam * scan.angle_increment for beam in count())
    forward = (
        reading for bearing, reading in zip(bearings, scan.ranges)
        if abs(atan2(sin(bearing), cos(bearing))) <= HALF_SECTOR)
    lowest, highest = scan.range_min, scan.range_max
    good = sorted(
        reading for reading in forward
        if reading in (inf, -inf) or lowest <= reading <= highest)
    return good[0] if good else None


def command_for(clearance):
    """Return the command that fits a clearance; None is to be blind."""
    match clearance:
        case None:
            forward, turn = 0.0, 0.0
        case distance if distance < SAFETY_DISTANCE:
            forward, turn = 0.0, TURN_RATE
        case _:
            forward, turn = FORWARD_SPEED, 0.0
    return Twist(linear=Vector3(x=forward), angular=Vector3(z=turn))


class RobotController(rclpy.node.Node):
    """Subscribes to scan and status, publishes cmd_vel."""

    def __init__(self, **kwargs):
        """Name the node; create what it listens to and what it says."""
        super().__init__('robot_controller', **kwargs)
        self.clearance_now = lambda: None  # what is known before the first scan
        self.status_sub = self.create_subscription(String, 'status', self.status_callback, 10)
        self.scan_sub = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, rclpy.qos.qos_profile_sensor_data)
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.timer = self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg):
        """Remember what the scan says, and until when it says so."""
        clock = self.get_clock()
        deadline = clock.now() + SCAN_TIMEOUT
        self.clearance_now = lambda: None if clock.now() > deadline else forward_clearance(msg)

    def status_callback(self, msg):
        """Log the status."""
        self.get_logger().info('The status is now: ' + msg.data)

    def control_loop(self):
        """Publish the command for what is known now."""
        clearance = self.clearance_now()
        command = command_for(clearance)
        self.cmd_vel_pub.publish(command)
        if command.angular.z:
            self.get_logger().warning(
                'Too near' if clearance == -inf else f'Only {clearance:.3f} m left',
                throttle_duration_sec=1.0)


def main(args=None):
    """Run until SIGINT or SIGTERM."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        executor = rclpy.executors.SingleThreadedExecutor()
        executor.add_node(node)
        while rclpy.ok():
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
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
