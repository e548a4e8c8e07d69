"""The clearance ahead, from the fields of a scan, without ROS."""

import math

HALF_SECTOR = math.radians(30.0)


def bearings(scan):
    """Yield the bearing of each beam, from -pi to pi."""
    for index in range(len(scan.ranges)):
        yield math.remainder(scan.angle_min + scan.angle_increment * index, 2.0 * math.pi)


def is_usable(reading, scan):
    """Return whether a reading is usable, as defined by REP 117."""
    return math.isinf(reading) or scan.range_min <= reading <= scan.range_max


def forward_clearance(scan):
    """Return the smallest usable reading in front (it may be inf or -inf), or None."""
    ahead = (
        reading for bearing, reading in zip(bearings(scan), scan.ranges)
        if abs(bearing) <= HALF_SECTOR
    )
    return min((reading for reading in ahead if is_usable(reading, scan)), default=None)
