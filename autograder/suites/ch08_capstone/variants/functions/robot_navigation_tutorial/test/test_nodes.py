"""The parts without ROS."""

import math
from types import SimpleNamespace

from robot_navigation_tutorial.sensor_processor import process
from sensor_msgs.msg import LaserScan


def test_a_blind_scan_is_not_valid():
    """Nothing but nan."""
    scan = LaserScan(range_min=0.1, range_max=5.0, angle_increment=0.1, ranges=[math.nan] * 62)
    assert not process(0.5, scan).valid


def test_a_wall_ahead_is_seen():
    """At bearing 0."""
    scan = LaserScan(range_min=0.1, range_max=5.0, angle_increment=0.1, ranges=[2.0] * 62)
    scan.ranges[0] = 1.0
    found = process(0.5, scan)
    assert found.valid
    assert SimpleNamespace(front=found.front, left=found.left).__dict__ == {"front": 1.0, "left": 2.0}
