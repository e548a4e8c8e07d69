"""Converts exact distances to a lidar's readings: float32 ranges with noise and REP 117's codes, and intensities."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Float32s = NDArray[np.float32]

# The intensity of a return at the sensor. At a distance of d metres, it is divided by 1 + d².
STRENGTH = 1000.0


def to_readings(
    ranges: Floats, noise: Floats, sigma: float, range_min: float, range_max: float, strengths: bool
) -> tuple[Float32s, Float32s]:
    """Convert distances (beams,) in metres to ranges and intensities (beams,).

    `noise` is empty, or contains a standard normal number for each beam, which is scaled by `sigma` metres. By REP 117,
    a range is `+inf` beyond `range_max` and `-inf` below `range_min`. If not `strengths`, the intensities are empty.
    """
    count = len(ranges)
    result = np.empty(count, dtype=np.float32)
    returns = np.empty(count if strengths else 0, dtype=np.float32)
    has_noise = len(noise) > 0
    for beam in range(count):
        distance = ranges[beam]
        if distance <= range_max and has_noise:
            distance = distance + sigma * noise[beam]
        if distance > range_max:
            distance = math.inf
        elif distance < range_min:
            distance = -math.inf
        reading = np.float32(distance)
        result[beam] = reading
        if strengths:
            value = np.float64(reading)
            returns[beam] = np.float32(STRENGTH / (1.0 + value * value)) if value >= 0.0 else np.float32(0.0)
    return result, returns
