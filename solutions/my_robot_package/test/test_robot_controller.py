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

"""What the controller sees in a scan, and what it then commands."""

import math

from geometry_msgs.msg import Twist
from my_robot_package.nodes.robot_controller import forward_clearance, RobotController
import pytest
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan

NAN = math.nan
INF = math.inf


def scan(readings, angle_min=-math.pi, fill=INF):
    """Return a scan of 360 beams: the readings by bearing in degrees, fill elsewhere."""
    msg = LaserScan(range_min=0.1, range_max=10.0, angle_min=angle_min)
    msg.angle_increment = math.radians(1.0)
    msg.ranges = [fill] * 360
    for bearing, reading in readings.items():
        msg.ranges[round(bearing - math.degrees(angle_min)) % 360] = reading
    return msg


@pytest.mark.parametrize('angle_min', [-math.pi, 0.0])
@pytest.mark.parametrize('bearing', [-29, 0, 29])
def test_a_wall_in_the_forward_sector_is_seen(angle_min, bearing):
    """Forward is bearing 0, wherever the scan starts."""
    assert forward_clearance(scan({bearing: 0.5}, angle_min)) == 0.5


@pytest.mark.parametrize('angle_min', [-math.pi, 0.0])
@pytest.mark.parametrize('bearing', [-31, 31, 90, 180])
def test_a_wall_elsewhere_is_not(angle_min, bearing):
    """Walls beside and behind do not matter."""
    assert forward_clearance(scan({bearing: 0.5}, angle_min)) == INF


@pytest.mark.parametrize(('reading', 'expected'), [
    (NAN, 3.0), (INF, 3.0), (-INF, -INF), (0.0, 3.0), (0.05, 3.0), (12.0, 3.0), (0.25, 0.25),
])
def test_a_reading_counts_by_rep_117(reading, expected):
    """One odd reading beside a wall 3 m away."""
    assert forward_clearance(scan({0: reading, 5: 3.0})) == expected


@pytest.mark.parametrize('fill', [NAN, 0.0])
def test_no_reading_that_counts_is_no_clearance(fill):
    """A lidar that returns nothing usable says nothing, which is not "clear"."""
    assert forward_clearance(scan({}, fill=fill)) is None


def test_no_beams_is_no_clearance():
    """An empty scan says nothing either."""
    assert forward_clearance(LaserScan(range_max=10.0)) is None


class Robot(Node):
    """The other side of the controller's topics: a best-effort lidar and a motor."""

    def __init__(self, context):
        super().__init__('robot', context=context)
        self.lidar = self.create_publisher(LaserScan, 'scan', qos_profile_sensor_data)
        self.commands = []
        self.create_subscription(Twist, 'cmd_vel', self.commands.append, 10)


@pytest.fixture
def robot(world):
    """Return a robot whose controller runs in the same world."""
    robot = world.add(Robot(world.context))
    world.add(RobotController(context=world.context))
    world.until(lambda: robot.lidar.get_subscription_count() and robot.commands)
    return robot


def speeds(robot, world):
    """Return the next command's forward speed and turn rate."""
    count = len(robot.commands)
    world.until(lambda: len(robot.commands) > count)
    return robot.commands[-1].linear.x, robot.commands[-1].angular.z


def test_it_stands_still_before_the_first_scan(robot, world):
    """No scan is not a clear scan."""
    assert speeds(robot, world) == (0.0, 0.0)


@pytest.mark.parametrize(('readings', 'expected'), [({}, (0.3, 0.0)), ({0: 0.6}, (0.0, 0.5))])
def test_it_drives_when_clear_and_turns_when_blocked(robot, world, readings, expected):
    """The command follows the newest scan, over real topics."""
    robot.create_timer(0.05, lambda: robot.lidar.publish(scan(readings)))
    world.until(lambda: speeds(robot, world) == expected)


def test_it_stops_when_the_lidar_dies(robot, world):
    """A scan older than the time-out says nothing about now."""
    lidar = robot.create_timer(0.05, lambda: robot.lidar.publish(scan({})))
    world.until(lambda: speeds(robot, world) == (0.3, 0.0))
    lidar.cancel()
    world.until(lambda: speeds(robot, world) == (0.0, 0.0))
