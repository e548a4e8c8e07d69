"""Sectors of a scan, in the style of arrays."""

import math

import numpy as np

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2


def nearest(scan, middle, half_angle):
    """Return the nearest distance around a bearing, or nan."""
    ranges = np.asarray(scan.ranges, dtype=float)
    away = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment - middle
    away = np.abs(np.arctan2(np.sin(away), np.cos(away)))
    counts = np.isinf(ranges) | ((ranges >= scan.range_min) & (ranges <= scan.range_max))
    chosen = ranges[counts & (away <= half_angle)]
    return float(chosen.min()) if chosen.size else math.nan
