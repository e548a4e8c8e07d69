"""What a scan says of the way ahead: no ROS in here but for the message's fields."""

import math

HALF_SECTOR = math.radians(30.0)


def bearings(scan):
    """Yield the bearing of each beam, from -pi to pi."""
    for number in range(len(scan.ranges)):
        yield math.remainder(scan.angle_min + scan.angle_increment * number, 2.0 * math.pi)


def counts(reading, scan):
    """Return whether a reading says anything, by REP 117."""
    return math.isinf(reading) or scan.range_min <= reading <= scan.range_max


def forward_clearance(scan):
    """Return the distance to the nearest thing in front, inf, -inf or None."""
    ahead = (
        reading for bearing, reading in zip(bearings(scan), scan.ranges)
        if abs(bearing) <= HALF_SECTOR
    )
    return min((reading for reading in ahead if counts(reading, scan)), default=None)
