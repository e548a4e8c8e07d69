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

"""Drive forward, turn left when something is in the way, and stand still when blind."""

import math

from geometry_msgs.msg import Twist
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1  # s: 10 commands a second
FORWARD_SPEED = 0.3  # m/s
TURN_RATE = 0.5  # rad/s, positive is to the left
SAFETY_DISTANCE = 1.0  # m: anything nearer in front is an obstacle
HALF_SECTOR = math.radians(30.0)  # rad: "in front" is this far to each side
SCAN_TIMEOUT = Duration(seconds=0.5)  # a scan older than this says nothing about now


def forward_clearance(scan):
    """
    Return the distance to the nearest thing in front of the robot, in metres.

    A beam looks forward when its bearing, angle_min + i * angle_increment wrapped to
    (-pi, pi], is within HALF_SECTOR of 0. REP 117 says how its reading counts:

    nan                               invalid, as if the beam were not there
    +inf                              nothing within range_max
    -inf                              something nearer than range_min
    range_min <= reading <= range_max a distance
    any other number                  a phantom, as if the beam were not there

    So the answer is a distance, math.inf (all clear), -math.inf (too near to measure), or
    None when no forward beam has a reading that counts.
    """
    readings = [
        reading
        for index, reading in enumerate(scan.ranges)
        if abs(math.remainder(scan.angle_min + index * scan.angle_increment, math.tau))
        <= HALF_SECTOR
        and (math.isinf(reading) or scan.range_min <= reading <= scan.range_max)
    ]
    return min(readings, default=None)


class RobotController(Node):
    """
    Ten times a second, turn the newest lidar scan into a velocity command.

    Subscribes to scan (sensor_msgs/LaserScan) and status (std_msgs/String), publishes
    cmd_vel (geometry_msgs/Twist).
    """

    def __init__(self, **kwargs):
        """
        Name the node robot_controller; create its publisher, subscriptions and timer.

        cmd_vel: a queue of 10. scan: qos_profile_sensor_data, because a lidar publishes
        best-effort and a reliable subscription would never match it. status: a queue of 10.
        The timer calls control_loop every CONTROL_PERIOD. kwargs are passed on to Node, so
        that a test can pass its own context.
        """
        super().__init__('robot_controller', **kwargs)
        self.last_scan = None
        self.last_scan_time = None
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self.create_subscription(String, 'status', self.status_callback, 10)
        self.create_timer(CONTROL_PERIOD, self.control_loop)
        self.get_logger().info('Robot controller initialised')

    def scan_callback(self, msg):
        """Remember the scan and the ROS time at which it arrived (self.get_clock())."""
        self.last_scan = msg
        self.last_scan_time = self.get_clock().now()

    def status_callback(self, msg):
        """Log the status's text at level info."""
        self.get_logger().info(f'Status: {msg.data}')

    def control_loop(self):
        """
        Publish exactly one command at each call, even when the robot stands still.

        No scan yet, a newest scan older than SCAN_TIMEOUT, or no forward reading that
        counts: stand still. Something nearer than SAFETY_DISTANCE: turn at TURN_RATE on the
        spot, and warn once a second. Otherwise: FORWARD_SPEED, straight on.
        """
        command = Twist()
        clearance = self.current_clearance()
        if clearance is None:
            pass  # blind: a Twist is all zeros from the start, which is "stop"
        elif clearance < SAFETY_DISTANCE:
            command.angular.z = TURN_RATE
            self.get_logger().warning(
                f'Obstacle ahead at {clearance:.2f} m', throttle_duration_sec=1.0)
        else:
            command.linear.x = FORWARD_SPEED
        self.cmd_vel_pub.publish(command)

    def current_clearance(self):
        """Return the newest scan's forward_clearance, or None without a fresh scan."""
        if self.last_scan is None:
            return None
        if self.get_clock().now() - self.last_scan_time > SCAN_TIMEOUT:
            return None
        return forward_clearance(self.last_scan)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():  # if not, a signal came between two waits, and rclpy raised this
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
