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

"""Wander about: straight on while the way is clear, to the left while it is not."""

import math
from typing import NamedTuple, Optional

from geometry_msgs.msg import Twist
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1  # s: 10 commands a second
FORWARD_SPEED = 0.3  # m/s
TURN_RATE = 0.5  # rad/s, positive is to the left
SAFETY_DISTANCE = 1.0  # m: anything nearer in front is an obstacle
HALF_SECTOR = math.radians(30.0)  # rad: "in front" is this far to each side
SCAN_TIMEOUT = Duration(seconds=0.5)  # a scan older than this says nothing about now

FORWARD_COSINE = math.cos(HALF_SECTOR)  # the cosine of a forward bearing is at least this


class Velocity(NamedTuple):
    """What the robot is told: metres and radians per second."""

    linear: float = 0.0
    angular: float = 0.0


STOP = Velocity()
LEFT = Velocity(angular=TURN_RATE)
AHEAD = Velocity(linear=FORWARD_SPEED)


def counts(reading: float, scan: LaserScan) -> bool:
    """Return whether a reading says something, by REP 117."""
    if math.isnan(reading):
        return False
    return math.isinf(reading) or scan.range_min <= reading <= scan.range_max


def forward_clearance(scan: LaserScan) -> Optional[float]:
    """
    Return the distance to the nearest thing in front of the robot, in metres.

    That is math.inf when nothing is there, -math.inf when it is too near to be measured, and
    None when no forward beam has a reading that counts.
    """
    nearest = None
    bearing_of_first, step = scan.angle_min, scan.angle_increment
    for number, reading in enumerate(scan.ranges):
        # a cosine knows neither turns nor directions of counting
        if math.cos(bearing_of_first + number * step) < FORWARD_COSINE:
            continue
        if counts(reading, scan) and (nearest is None or reading < nearest):
            nearest = reading
    return nearest


def decide(clearance: Optional[float]) -> Velocity:
    """Return what to do with so much room in front; None is not to know it."""
    if clearance is None:
        return STOP
    return LEFT if clearance < SAFETY_DISTANCE else AHEAD


class RobotController(Node):
    """
    Ten times a second, turn the newest lidar scan into a velocity command.

    Subscribes to scan (sensor_msgs/LaserScan) and status (std_msgs/String), publishes
    cmd_vel (geometry_msgs/Twist).
    """

    def __init__(self, **kwargs):
        """Name the node; create its publisher, subscriptions and timer."""
        super().__init__('robot_controller', **kwargs)
        self.scan: Optional[LaserScan] = None
        self.scan_arrival: Optional[Time] = None
        self.commands = self.create_publisher(Twist, 'cmd_vel', 10)
        self.subscribed = [
            self.create_subscription(
                LaserScan, 'scan', self.scan_callback, qos_profile=qos_profile_sensor_data),
            self.create_subscription(
                String, 'status', self.status_callback, qos_profile=10),
        ]
        self.ticks = self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg: LaserScan) -> None:
        """Remember the scan and the ROS time at which it arrived (self.get_clock())."""
        self.scan, self.scan_arrival = msg, self.get_clock().now()

    def status_callback(self, msg: String) -> None:
        """Log the status's text at level info."""
        self.get_logger().info(msg.data)

    def control_loop(self) -> None:
        """Publish exactly one command at each call, also to stand still."""
        velocity = decide(self.current_clearance())
        if velocity is LEFT:
            self.get_logger().warning('Something is in the way', throttle_duration_sec=1.0)
        command = Twist()
        command.linear.x, command.angular.z = velocity
        self.commands.publish(command)

    def current_clearance(self) -> Optional[float]:
        """Return the newest scan's forward_clearance, or None without a fresh scan."""
        if self.scan is None or self.scan_arrival is None:
            return None
        age = self.get_clock().now() - self.scan_arrival
        return None if age > SCAN_TIMEOUT else forward_clearance(self.scan)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = RobotController()
        rclpy.spin(node, executor=SingleThreadedExecutor())
    except RuntimeError:
        if rclpy.ok():  # no signal came, so this is an error
            raise
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # this is how it is meant to end
    finally:
        if node:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
