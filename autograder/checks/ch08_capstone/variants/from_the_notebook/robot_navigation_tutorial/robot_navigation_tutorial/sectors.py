"""How near things are, sector by sector."""

import math

import numpy as np

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2


def nearest(scan, middle, half_angle):
    """Return the nearest reading of the sector, or nan."""
    readings = np.asarray(scan.ranges, dtype=float)
    bearings = scan.angle_min + scan.angle_increment * np.arange(readings.size)
    away = np.abs((bearings - middle + np.pi) % (2.0 * np.pi) - np.pi)
    within = (readings >= scan.range_min) & (readings <= scan.range_max)
    counted = readings[(away <= half_angle) & (np.isinf(readings) | within)]
    return float(counted.min()) if counted.size else math.nan
