"""From exact distances to what a lidar reports: noise, the codes of REP 117, single precision, intensities."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Float32s = NDArray[np.float32]

# The intensity of a return at the sensor; it falls to a half at 1 m, and from there with the square of the distance.
STRENGTH = 1000.0


def to_readings(
    ranges: Floats, noise: Floats, sigma: float, range_min: float, range_max: float, strengths: bool
) -> tuple[Float32s, Float32s]:
    """Return the ranges and the intensities (beams,) of distances (beams,) in metres.

    `noise` is empty or holds a standard normal number a beam, of which `sigma` metres are added to a return. REP 117:
    `+inf` beyond `range_max`, `-inf` below `range_min`. The intensities are empty where they are not asked for.
    """
    count = len(ranges)
    result = np.empty(count, dtype=np.float32)
    returns = np.empty(count if strengths else 0, dtype=np.float32)
    noisy = len(noise) > 0
    for beam in range(count):
        distance = ranges[beam]
        if distance <= range_max and noisy:
            distance = distance + sigma * noise[beam]
        if distance > range_max:
            distance = math.inf
        elif distance < range_min:
            distance = -math.inf
        reading = np.float32(distance)
        result[beam] = reading
        if strengths:
            back = np.float64(reading)
            returns[beam] = np.float32(STRENGTH / (1.0 + back * back)) if back >= 0.0 else np.float32(0.0)
    return result, returns
