"""A controller of 08 that is graded alone gets the clearances that the reference would compute."""

from __future__ import annotations

import math
import random
import runpy

from sensor_msgs.msg import LaserScan

from autograder import course_paths
from autograder.checks.ch08_capstone.support.clearances import MIDDLES, nearest

SECTORS = course_paths.SOLUTIONS / "robot_navigation_tutorial/robot_navigation_tutorial/sectors.py"
READINGS = (math.nan, math.inf, -math.inf, 0.0, 0.05, 0.12, 3.5, 9.0)


def _scan(draw: random.Random) -> LaserScan:
    scan = LaserScan(range_min=0.12, range_max=3.5, angle_min=draw.uniform(-math.pi, math.pi))
    beams = draw.randrange(60)
    scan.angle_increment = draw.choice((1, -1)) * math.tau / max(beams, 1)
    scan.ranges = [draw.choice((*READINGS, draw.uniform(0.2, 3.0))) for _ in range(beams)]
    return scan


def test_each_sector_has_the_nearest_reading_that_counts() -> None:
    reference = runpy.run_path(str(SECTORS))["nearest"]
    for seed in range(1000):
        scan, half = _scan(random.Random(seed)), random.Random(seed).uniform(0.1, 0.78)
        for middle in MIDDLES.values():
            computed, expected = nearest(scan, middle, half), reference(scan, middle, half)
            assert computed == expected or (math.isnan(computed) and math.isnan(expected))
