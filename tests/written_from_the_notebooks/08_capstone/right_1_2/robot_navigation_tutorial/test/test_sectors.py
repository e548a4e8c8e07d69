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

"""The sectors, tried with many scans."""

import math

import pytest
from robot_navigation_tutorial import sectors
from sensor_msgs.msg import LaserScan

MIDDLES = {'front': 0, 'left': 90, 'right': -90}
WIDTH = 0.4


def scan(readings, angle_min=-math.pi, fill=math.inf):
    """Return a scan of 360 beams: the readings by bearing in degrees, fill elsewhere."""
    msg = LaserScan(range_min=0.1, range_max=10.0, angle_min=angle_min)
    msg.angle_increment = math.radians(1.0)
    msg.ranges = [fill] * 360
    for degrees, reading in readings.items():
        msg.ranges[round(degrees - math.degrees(angle_min)) % 360] = reading
    return msg


def look(seen, name):
    """Return the distance in a sector of this name."""
    return sectors.nearest(seen, getattr(sectors, name.upper()), WIDTH)


@pytest.fixture(params=[-math.pi, 0.0], ids=['from behind', 'from the front'])
def start(request):
    """Return where the scan starts."""
    return request.param


@pytest.mark.parametrize('name', MIDDLES)
@pytest.mark.parametrize('aside', [-20, 0, 20])
def test_each_sector_sees_its_own_wall(start, name, aside):
    """The others do not."""
    seen = scan({MIDDLES[name] + aside: 2.5}, start)
    found = {other: look(seen, other) for other in MIDDLES}
    assert found.pop(name) == 2.5
    assert set(found.values()) == {math.inf}


@pytest.mark.parametrize('name', MIDDLES)
@pytest.mark.parametrize('odd', [math.nan, 0.0, 0.03125, 10.5, -2.0])
def test_what_does_not_count(start, name, odd):
    """It neither hides the wall nor is one."""
    middle = MIDDLES[name]
    for aside in (-5, 5):
        assert look(scan({middle: 2.5, middle + aside: odd}, start), name) == 2.5
    assert math.isnan(look(scan({}, start, fill=odd), name))


@pytest.mark.parametrize('name', MIDDLES)
def test_too_near_to_measure(start, name):
    """Nothing is nearer than that."""
    assert look(scan({MIDDLES[name]: -math.inf, MIDDLES[name] + 1: 0.5}, start), name) == -math.inf
