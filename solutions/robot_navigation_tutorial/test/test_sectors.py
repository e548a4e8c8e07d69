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

"""What counts as the nearest thing in a sector."""

import math

import pytest
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT
from sensor_msgs.msg import LaserScan

NAN = math.nan
INF = math.inf
HALF = 0.52


def scan(readings, angle_min=-math.pi, fill=INF):
    """Return a scan of 360 beams: the readings by bearing in degrees, fill elsewhere."""
    msg = LaserScan(range_min=0.1, range_max=10.0, angle_min=angle_min)
    msg.angle_increment = math.radians(1.0)
    msg.ranges = [fill] * 360
    for degrees, reading in readings.items():
        msg.ranges[round(degrees - math.degrees(angle_min)) % 360] = reading
    return msg


@pytest.mark.parametrize('angle_min', [-math.pi, 0.0])
@pytest.mark.parametrize(('degrees', 'sector'), [
    (-29, 'front'), (0, 'front'), (29, 'front'), (61, 'left'), (119, 'left'), (-61, 'right'),
    (-119, 'right'), (45, None), (-45, None), (121, None), (-121, None), (180, None),
])
def test_a_thing_is_in_the_sector_of_its_bearing(angle_min, degrees, sector):
    """Wherever the scan starts, 0 is forward and left is positive."""
    seen = scan({degrees: 0.5}, angle_min)
    for name, middle in {'front': FRONT, 'left': LEFT, 'right': RIGHT}.items():
        assert nearest(seen, middle, HALF) == (0.5 if name == sector else INF)


@pytest.mark.parametrize(('reading', 'expected'), [
    (NAN, 3.0), (INF, 3.0), (-INF, -INF), (0.0, 3.0), (0.05, 3.0), (12.0, 3.0), (0.25, 0.25),
])
def test_a_reading_counts_by_rep_117(reading, expected):
    """One odd reading next to a wall 3 m away, before and after it in the list."""
    assert nearest(scan({0: reading, 5: 3.0}), FRONT, HALF) == expected
    assert nearest(scan({0: 3.0, 5: reading}), FRONT, HALF) == expected


@pytest.mark.parametrize('fill', [NAN, 0.0, 12.0])
def test_without_a_reading_that_counts_the_distance_is_nan(fill):
    """A blind sector is not a clear one."""
    assert math.isnan(nearest(scan({90: 1.0}, fill=fill), FRONT, HALF))


def test_a_scan_without_beams_says_nothing():
    """No beam, no distance."""
    assert math.isnan(nearest(LaserScan(range_max=10.0), FRONT, HALF))
