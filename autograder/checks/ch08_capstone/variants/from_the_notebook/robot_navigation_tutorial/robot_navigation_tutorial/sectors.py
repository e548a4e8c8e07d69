"""The nearest distance in a sector, computed with arrays."""

import math

import numpy as np

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2


def nearest(scan, middle, half_angle):
    """Return the nearest valid reading of the sector, or nan."""
    readings = np.asarray(scan.ranges, dtype=float)
    bearings = scan.angle_min + scan.angle_increment * np.arange(readings.size)
    difference = np.abs((bearings - middle + np.pi) % (2.0 * np.pi) - np.pi)
    within = (readings >= scan.range_min) & (readings <= scan.range_max)
    valid = readings[(difference <= half_angle) & (np.isinf(readings) | within)]
    return float(valid.min()) if valid.size else math.nan
