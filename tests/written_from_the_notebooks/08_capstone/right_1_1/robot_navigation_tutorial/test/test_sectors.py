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

"""Tests of nearest, one idea in each."""

import math

from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT
from sensor_msgs.msg import LaserScan


def scan(readings, angle_min=-math.pi, fill=math.inf):
    """Return a scan of 360 beams: the readings by bearing in degrees, fill elsewhere."""
    msg = LaserScan(range_min=0.1, range_max=10.0, angle_min=angle_min)
    msg.angle_increment = math.radians(1.0)
    msg.ranges = [fill] * 360
    for degrees, reading in readings.items():
        msg.ranges[round(degrees - math.degrees(angle_min)) % 360] = reading
    return msg


def test_a_wall_ahead():
    """It is ahead wherever the scan starts, and on no side."""
    for angle_min in (-math.pi, 0.0):
        seen = scan({3: 0.75}, angle_min)
        assert nearest(seen, FRONT, 0.5) == 0.75
        assert nearest(seen, LEFT, 0.5) == math.inf
        assert nearest(seen, RIGHT, 0.5) == math.inf


def test_a_wall_on_the_left():
    """Left is positive."""
    for angle_min in (-math.pi, 0.0):
        seen = scan({80: 0.75}, angle_min)
        assert nearest(seen, LEFT, 0.5) == 0.75
        assert nearest(seen, RIGHT, 0.5) == math.inf
        assert nearest(seen, FRONT, 0.5) == math.inf


def test_a_wall_on_the_right():
    """Right is negative."""
    for angle_min in (-math.pi, 0.0):
        seen = scan({-80: 0.75}, angle_min)
        assert nearest(seen, RIGHT, 0.5) == 0.75
        assert nearest(seen, LEFT, 0.5) == math.inf
        assert nearest(seen, FRONT, 0.5) == math.inf


def test_a_wall_behind():
    """It is in no sector."""
    seen = scan({180: 0.75})
    assert [nearest(seen, middle, 0.5) for middle in (FRONT, LEFT, RIGHT)] == 3 * [math.inf]


def test_failed_beams():
    """A beam that failed hides nothing, whether it comes before the wall or after it."""
    seen = scan({-10: math.nan, 0: 1.5, 10: math.nan})
    assert nearest(seen, FRONT, 0.5) == 1.5


def test_phantoms():
    """Numbers outside the lidar's range are no walls, and no free space."""
    seen = scan({-10: 0.0, 0: 1.5, 5: 0.0625, 10: -1.0})
    assert nearest(seen, FRONT, 0.5) == 1.5
    for phantom in (0.0, 0.0625, 11.0):
        assert math.isnan(nearest(scan({}, fill=phantom), FRONT, 0.5))


def test_infinities():
    """Nothing in range, and something too near to be measured."""
    assert nearest(scan({}), FRONT, 0.5) == math.inf
    assert nearest(scan({0: -math.inf, 5: 1.5}), FRONT, 0.5) == -math.inf


def test_nothing_counts():
    """Without a reading there is no distance."""
    assert math.isnan(nearest(scan({}, fill=math.nan), LEFT, 0.5))
