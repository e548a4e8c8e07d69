"""Converts exact distances to a lidar's readings, with noise, the codes of REP 117, single precision, intensities."""

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
    """Return the ranges and the intensities (beams,) of distances (beams,) in metres.

    `noise` is empty, or contains a standard normal number for each beam, which is scaled by `sigma` metres. By REP 117,
    a range is `+inf` beyond `range_max` and `-inf` below `range_min`. Without `strengths`, the intensities are empty.
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
            measured = np.float64(reading)
            returns[beam] = np.float32(STRENGTH / (1.0 + measured * measured)) if measured >= 0.0 else np.float32(0.0)
    return result, returns
