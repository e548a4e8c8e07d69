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

"""A reflex: see something near in front, and turn away from it; see nothing, and stand still."""

from contextlib import ExitStack, suppress
import math

from geometry_msgs.msg import Twist, Vector3
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
import rclpy.qos
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String

CONTROL_PERIOD = 0.1  # s
FORWARD_SPEED = 0.3  # m/s
TURN_RATE = 0.5  # rad/s
SAFETY_DISTANCE = 1.0  # m
HALF_SECTOR = math.pi / 6  # rad
SCAN_TIMEOUT = Duration(seconds=0.5)
WARNING_PERIOD = Duration(seconds=1.05)  # a little more than 1 s, so that it is never less


def forward_readings(scan):
    """Yield the readings of all beams that look forward, whatever they say."""
    bearing = (scan.angle_min + beam * scan.angle_increment for beam in range(len(scan.ranges)))
    for angle, reading in zip(bearing, scan.ranges):
        wrapped = (angle + math.pi) % math.tau - math.pi
        if -HALF_SECTOR <= wrapped <= HALF_SECTOR:
            yield reading


def forward_clearance(scan):
    """
    Return the distance to the nearest thing in front of the robot, in metres.

    The answer is a distance, math.inf (all clear), -math.inf (too near to measure), or None
    when no forward beam has a reading that counts.
    """
    clear = False
    distances = []
    for reading in forward_readings(scan):
        if reading == -math.inf:
            return reading  # nothing is nearer than that
        if reading == math.inf:
            clear = True
        elif scan.range_min <= reading <= scan.range_max:  # nan is not
            distances.append(reading)
    if distances:
        return sorted(distances)[0]
    return math.inf if clear else None


class RobotController(Node):
    """Ten times a second, turn the newest lidar scan into a velocity command."""

    def __init__(self, **kwargs):
        """Name the node robot_controller; create its publisher, subscriptions and timer."""
        super().__init__('robot_controller', **kwargs)
        self._clearance = None  # of the newest scan
        self._valid_until = None  # ROS time at which the newest scan gets too old
        self._last_warning = None  # ROS time

        sensor = rclpy.qos.QoSPresetProfiles.SENSOR_DATA.value
        queue = rclpy.qos.QoSProfile(depth=10)
        self._motor = self.create_publisher(Twist, 'cmd_vel', queue)
        self.create_subscription(LaserScan, 'scan', self.scan_callback, sensor)
        self.create_subscription(String, 'status', self.status_callback, queue)
        self.create_timer(CONTROL_PERIOD, self.control_loop)

    def scan_callback(self, msg):
        """Remember what the scan says and how long that is true."""
        self._valid_until = self.get_clock().now() + SCAN_TIMEOUT
        self._clearance = forward_clearance(msg)

    def status_callback(self, msg):
        """Log the status's text at level info."""
        self.get_logger().info('The status is "' + msg.data + '".')

    def control_loop(self):
        """Publish exactly one command at each call, also to stand still."""
        speed, rate = 0.0, 0.0
        room = self.current_clearance()
        if room is not None and room >= SAFETY_DISTANCE:
            speed = FORWARD_SPEED
        elif room is not None:
            rate = TURN_RATE
            self._warn(f'Only {room:.3f} m of room: turning left')
        self._motor.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=rate)))

    def current_clearance(self):
        """Return the newest scan's forward_clearance, or None without a fresh scan."""
        if self._valid_until is None or self.get_clock().now() > self._valid_until:
            return None
        return self._clearance

    def _warn(self, text):
        """Warn, but only when the last warning was long enough ago in ROS time."""
        now = self.get_clock().now()
        if self._last_warning is not None:
            silence = now - self._last_warning
            if Duration() <= silence < WARNING_PERIOD:  # negative: a simulator began anew
                return
        self._last_warning = now
        self.get_logger().warning(text)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    with ExitStack() as at_the_end:  # what is entered last is left first
        at_the_end.callback(rclpy.try_shutdown)
        at_the_end.enter_context(suppress(KeyboardInterrupt, ExternalShutdownException))
        try:
            node = RobotController()
            at_the_end.callback(node.destroy_node)
            rclpy.spin(node)
        except RuntimeError:
            if rclpy.ok():  # a real error; otherwise a signal came between two waits
                raise


if __name__ == '__main__':
    main()
