"""The distances that 08 accepts for a drawn scan contain those of the reference and of other correct ways."""

from __future__ import annotations

import math
import runpy

import numpy as np
from hypothesis import given, settings
from sensor_msgs.msg import LaserScan

from autograder import course_paths
from autograder.checks.ch08_capstone.hidden.clearances import OTHER_LIDARS
from autograder.checks.ch08_capstone.hidden.drawn_scans import DrawnScan, possible_distances
from autograder.checks.ch08_capstone.support.clearances import HALF_ANGLE, MIDDLES

SECTORS = course_paths.SOLUTIONS / "robot_navigation_tutorial/robot_navigation_tutorial/sectors.py"
REFERENCE = runpy.run_path(str(SECTORS))["nearest"]


def nearest_by_arrays(scan: LaserScan, middle: float) -> float:
    """Return the nearest reading of a sector that counts, with bearings of float32."""
    ranges = np.asarray(scan.ranges, np.float32)
    bearings = np.float32(scan.angle_min) + np.arange(ranges.size, dtype=np.float32) * np.float32(scan.angle_increment)
    away = np.arctan2(np.sin(bearings - np.float32(middle)), np.cos(bearings - np.float32(middle)))
    counts = np.isinf(ranges) | ((ranges >= scan.range_min) & (ranges <= scan.range_max))
    return float(min(ranges[counts & (np.abs(away) <= HALF_ANGLE)], default=math.nan))


@settings(max_examples=200, deadline=None)
@given(case=OTHER_LIDARS)
def test_correct_distances_are_accepted(case: DrawnScan) -> None:
    scan = case.message()
    for middle in MIDDLES.values():
        accepted = possible_distances(scan, middle)
        for distance in (REFERENCE(scan, middle, HALF_ANGLE), nearest_by_arrays(scan, middle)):
            assert distance in accepted or (math.isnan(distance) and any(map(math.isnan, accepted)))
