"""Tests of nearest: whose bearing it is, and whether it counts."""

from math import inf, isnan, nan, pi, radians

import pytest
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT
from sensor_msgs.msg import LaserScan

WIDTH = radians(30.0) + 0.001


def scan(readings, angle_min=-pi, fill=inf):
    """Return a scan of 360 beams: the readings by bearing in degrees, fill elsewhere."""
    msg = LaserScan(range_min=0.1, range_max=10.0, angle_min=angle_min)
    msg.angle_increment = radians(1.0)
    msg.ranges = [fill] * 360
    for degrees, reading in readings.items():
        msg.ranges[round(degrees - angle_min * 180.0 / pi) % 360] = reading
    return msg


@pytest.mark.parametrize('start', [-pi, 0.0, -pi / 2])
@pytest.mark.parametrize('degrees', [0, 10, -10, 29, -29])
def test_front(degrees, start):
    """A thing ahead is seen ahead, and nowhere else."""
    seen = scan({degrees: 1.5}, start)
    assert nearest(seen, FRONT, WIDTH) == 1.5
    assert nearest(seen, LEFT, WIDTH) == inf
    assert nearest(seen, RIGHT, WIDTH) == inf


@pytest.mark.parametrize('start', [-pi, 0.0, -pi / 2])
@pytest.mark.parametrize('degrees', [61, 90, 119])
def test_sides(degrees, start):
    """Left is positive, right is negative."""
    seen = scan({degrees: 1.5, -degrees: 2.5}, start)
    assert nearest(seen, FRONT, WIDTH) == inf
    assert nearest(seen, LEFT, WIDTH) == 1.5
    assert nearest(seen, RIGHT, WIDTH) == 2.5


@pytest.mark.parametrize('degrees', [33, 57, 123, 180, -33, -57, -123])
def test_between_the_sectors(degrees):
    """What is in no sector is not seen."""
    seen = scan({degrees: 1.5})
    assert [nearest(seen, middle, WIDTH) for middle in (FRONT, LEFT, RIGHT)] == [inf] * 3


@pytest.mark.parametrize('phantom', [0.0, -1.0, 0.09, nan])
@pytest.mark.parametrize('place', [-20, 0, 20])
def test_what_does_not_count_hides_nothing(phantom, place):
    """A wall of 2 m stays 2 m, whatever stands beside it."""
    walls = {degrees: 2.0 for degrees in range(-40, 41)}
    assert nearest(scan({**walls, place: phantom}), FRONT, WIDTH) == 2.0


@pytest.mark.parametrize('reading', [nan, 0.0, 0.09, 10.5, -3.0])
def test_nothing_counts(reading):
    """Without a reading that counts, nothing is known."""
    assert isnan(nearest(scan({}, fill=reading), FRONT, WIDTH))
    assert nearest(scan({3: 4.0}, fill=reading), FRONT, WIDTH) == 4.0


def test_infinities():
    """Too near is nearer than near, and nothing is farther than far."""
    assert nearest(scan({}), LEFT, WIDTH) == inf
    assert nearest(scan({90: -inf, 91: 0.2}), LEFT, WIDTH) == -inf
    assert nearest(scan({90: inf}, fill=nan), LEFT, WIDTH) == inf
