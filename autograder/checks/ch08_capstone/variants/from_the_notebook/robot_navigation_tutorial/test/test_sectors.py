"""The nearest distance in a sector."""

import math

import pytest
from robot_navigation_tutorial.sectors import FRONT, LEFT, nearest, RIGHT
from sensor_msgs.msg import LaserScan

HALF = 0.5
ALL = {'front': FRONT, 'left': LEFT, 'right': RIGHT}


def scan(things, background=math.inf, start=0.0):
    """Return a scan with one beam for each degree; `things` has readings by bearing in degrees."""
    result = LaserScan(
        angle_min=start, angle_increment=math.radians(1.0), range_min=0.1, range_max=5.0,
        ranges=[background] * 360)
    for degrees, reading in things.items():
        result.ranges[round(degrees - math.degrees(start)) % 360] = reading
    return result


@pytest.mark.parametrize('start', [0.0, -math.pi, -math.pi / 2])
@pytest.mark.parametrize(('degrees', 'sector'), [
    (0, 'front'), (20, 'front'), (-20, 'front'), (90, 'left'), (70, 'left'), (110, 'left'),
    (-90, 'right'), (-70, 'right'), (-110, 'right'), (45, None), (-45, None), (180, None)])
def test_a_thing_is_in_its_own_sector_alone(degrees, sector, start):
    """Whatever the first beam is, only one sector contains the thing."""
    laser_scan = scan({degrees: 1.5}, start=start)
    for name, middle in ALL.items():
        expected = 1.5 if name == sector else math.inf
        assert nearest(laser_scan, middle, HALF) == pytest.approx(expected)


@pytest.mark.parametrize('invalid', [math.nan, 0.0, 0.05, 5.5, 99.0, -1.0])
def test_what_is_no_measurement_does_not_count(invalid):
    """An invalid reading neither hides a wall nor is one."""
    things = {degrees: invalid for degrees in range(-10, 11)}
    assert nearest(scan({**things, 15: 2.0}), FRONT, HALF) == pytest.approx(2.0)
    assert nearest(scan({**things, -15: 2.0}), FRONT, HALF) == pytest.approx(2.0)
    assert nearest(scan(things), FRONT, HALF) == math.inf
    assert math.isnan(nearest(scan({}, background=invalid), FRONT, HALF))


def test_too_near_is_nearer_than_all():
    """A reading of -inf is the nearest thing."""
    assert nearest(scan({3: -math.inf, 5: 0.2}), FRONT, HALF) == -math.inf


def test_the_nearest_of_several_counts():
    """The order of beams does not matter."""
    for things in ({-5: 3.0, 5: 1.0}, {-5: 1.0, 5: 3.0}):
        assert nearest(scan(things), FRONT, HALF) == pytest.approx(1.0)


def test_the_half_angle_counts():
    """A narrow sector does not contain each thing that a wide one contains."""
    laser_scan = scan({20: 1.0})
    assert nearest(laser_scan, FRONT, 0.4) == pytest.approx(1.0)
    assert nearest(laser_scan, FRONT, 0.3) == math.inf


def test_no_beams_no_answer():
    """An empty scan has no valid reading."""
    assert math.isnan(nearest(LaserScan(), FRONT, HALF))
