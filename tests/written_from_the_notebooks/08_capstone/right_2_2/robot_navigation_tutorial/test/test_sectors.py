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

"""The nearest thing in a sector, beam by beam."""

import math

import pytest
from robot_navigation_tutorial import sectors
from sensor_msgs.msg import LaserScan

NEAREST = {
    'front': lambda msg: sectors.nearest(msg, sectors.FRONT, 0.4),
    'left': lambda msg: sectors.nearest(msg, sectors.LEFT, 0.4),
    'right': lambda msg: sectors.nearest(msg, sectors.RIGHT, 0.4),
}


def scan(readings, angle_min=-math.pi, fill=math.inf):
    """Return a scan of 360 beams: the readings by bearing in degrees, fill elsewhere."""
    msg = LaserScan(range_min=0.1, range_max=10.0, angle_min=angle_min)
    msg.angle_increment = math.radians(1.0)
    msg.ranges = [fill] * 360
    for degrees, reading in readings.items():
        msg.ranges[round(degrees - math.degrees(angle_min)) % 360] = reading
    return msg


@pytest.mark.parametrize('angle_min', [0.0, -math.pi, -1.0, math.pi])
def test_each_side_sees_its_own_wall(angle_min):
    """Three walls at three distances, wherever the scan starts."""
    msg = scan({5: 1.0, 85: 2.0, -85: 3.0, 170: 0.5}, angle_min)
    assert {side: ask(msg) for side, ask in NEAREST.items()} == {
        'front': 1.0, 'left': 2.0, 'right': 3.0}


@pytest.mark.parametrize('degrees', [-22, 22])
def test_the_edge_of_a_sector_is_just_inside(degrees):
    """0.4 rad are 22.9 degrees."""
    assert NEAREST['front'](scan({degrees: 1.0})) == 1.0


@pytest.mark.parametrize('degrees', [-24, 24, 66, -66, 114, -114])
def test_a_thing_beyond_the_edge_is_outside(degrees):
    """A beam of no sector is no concern of any."""
    assert {ask(scan({degrees: 1.0})) for ask in NEAREST.values()} == {math.inf}


@pytest.mark.parametrize('side', NEAREST)
@pytest.mark.parametrize('noise', [math.nan, 0.0, 0.05, 11.0])
def test_noise_neither_hides_a_wall_nor_is_one(side, noise):
    """One beam of each sector measures, and all others are noise."""
    assert NEAREST[side](scan({0: 4.0, 90: 4.0, -90: 4.0}, fill=noise)) == 4.0


@pytest.mark.parametrize('noise', [math.nan, 0.0, 0.05, 11.0])
def test_only_noise_is_no_distance(noise):
    """Not even the infinity that means a clear way."""
    assert math.isnan(NEAREST['front'](scan({180: 1.0}, fill=noise)))


@pytest.mark.parametrize('noise', [math.nan, 0.0, 0.05])
@pytest.mark.parametrize('degrees', [-21, 0, 21])
def test_one_bad_beam_before_a_wall(noise, degrees):
    """The wall is there, whether the bad beam is the first or the last of its sector."""
    assert NEAREST['front'](scan({degrees: noise}, fill=3.0)) == 3.0


def test_the_infinities_say_something():
    """A thing too near to measure is nearer than all others."""
    assert NEAREST['front'](scan({0: 0.2, 1: -math.inf})) == -math.inf
    assert NEAREST['right'](scan({}, fill=math.inf)) == math.inf
