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

"""Steer by the lidar: forward, to the left, or not at all."""

import math
from typing import NamedTuple

from geometry_msgs.msg import Twist
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1  # s
FORWARD_SPEED = 0.3  # m/s
TURN_RATE = 0.5  # rad/s
SAFETY_DISTANCE = 1.0  # m
HALF_SECTOR = math.pi / 6.0  # rad
SCAN_TIMEOUT = Duration(seconds=0.5)
WARNING_PERIOD = Duration(seconds=1.0)

STOP = (0.0, 0.0)
AHEAD = (FORWARD_SPEED, 0.0)
ASIDE = (0.0, TURN_RATE)


class Sighting(NamedTuple):
    """What the newest scan said, and the ROS time at which it arrived."""

    clearance: float | None
    time: Time


def counts(reading, scan):
    """Say whether a reading is a distance, all clear, or very near (REP 117)."""
    if math.isnan(reading):
        return False
    if math.isinf(reading):
        return True
    return not (reading < scan.range_min or reading > scan.range_max)


def forward_clearance(scan):
    """Return the distance to the nearest thing in front, or None when nothing there counts."""
    nearest = None
    for index, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + index * scan.angle_increment
        bearing -= math.tau * round(bearing / math.tau)
        if not -HALF_SECTOR <= bearing <= HALF_SECTOR:
            continue
        if counts(reading, scan) and (nearest is None or reading < nearest):
            nearest = reading
    return nearest


class RobotController(Node):
    """A robot that turns away from what is in front of it."""

    def __init__(self, **kwargs):
        """Create the node's endpoints and its timer."""
        super().__init__('robot_controller', **kwargs)
        self._sighting = None
        self._warned = None
        self._wheels = self.create_publisher(Twist, 'cmd_vel', 10)
        self._lidar = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, qos_profile_sensor_data)
        self._news = self.create_subscription(String, 'status', self.status_callback, 10)
        self._ticker = self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg):
        """Look at the scan as it arrives."""
        self._sighting = Sighting(forward_clearance(msg), self.get_clock().now())

    def status_callback(self, msg):
        """Log the text."""
        self.get_logger().info(msg.data)

    def control_loop(self):
        """Publish one command."""
        linear, angular = self._decide()
        twist = Twist()
        twist.linear.x, twist.angular.z = linear, angular
        self._wheels.publish(twist)

    def _decide(self):
        """Return the forward speed and the turn rate for this moment."""
        seen = self._sighting
        now = self.get_clock().now()
        if seen is None or seen.clearance is None or now - seen.time > SCAN_TIMEOUT:
            return STOP
        if seen.clearance >= SAFETY_DISTANCE:
            return AHEAD
        self._warn(now, f'Something is {seen.clearance:.2f} m in front of me')
        return ASIDE

    def _warn(self, now, text):
        """Log a warning unless there was one within the last second (of ROS time)."""
        if self._warned is None or not Duration() <= now - self._warned < WARNING_PERIOD:
            self._warned = now
            self.get_logger().warning(text)


def main(args=None):
    """Run the node until it is told to stop."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        rclpy.spin(node, SingleThreadedExecutor())
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
