"""Sectors of a laser scan: plain geometry, no ROS."""

import math

FRONT = 0.0  # rad
LEFT = math.radians(90.0)
RIGHT = -LEFT


def nearest(scan, middle, half_angle):
    """
    Find the smallest reading that counts among the beams around a bearing.

    Angles are in radians, distances in metres. A reading that is nan, or finite and not from
    range_min to range_max, does not count. The answer is nan when no reading counts.
    """
    best = math.nan
    for number, reading in enumerate(scan.ranges):
        bearing = scan.angle_min + number * scan.angle_increment
        away = math.fmod(abs(bearing - middle), math.tau)
        away = min(away, math.tau - away)  # the other way round may be shorter
        if away > half_angle or math.isnan(reading):
            continue
        if math.isfinite(reading) and not scan.range_min <= reading <= scan.range_max:
            continue
        if math.isnan(best) or reading < best:
            best = reading
    return best
