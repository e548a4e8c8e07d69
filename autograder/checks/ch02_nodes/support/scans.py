"""Builds laser scans beam by beam."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sensor_msgs.msg import LaserScan

RANGE_MIN, RANGE_MAX = 0.12, 3.5  # m: the limits of an LDS-01 lidar


@dataclass(frozen=True)
class Part:
    """The beams from bearing `first` to bearing `last` (degrees, 0 is forward, left is positive) read `value` m."""

    first: float
    last: float
    value: float


# An obstacle just beyond range_min, and nearer than any limit that a robot may have.
JUST_AHEAD = Part(-10.0, 10.0, 0.15)


def scan(
    *parts: Part,
    fill: float = 3.0,
    beams: int = 360,
    first_bearing: float = 0.0,
    last_bearing: float | None = None,
    limits: tuple[float, float] = (RANGE_MIN, RANGE_MAX),
) -> LaserScan:
    """Return a scan that reads `fill` everywhere except in `parts`; a later part replaces an earlier one.

    Args:
        parts: the beams with other readings.
        fill: the reading of all other beams, in metres.
        beams: the number of beams.
        first_bearing: the bearing of beam 0 in degrees.
        last_bearing: the bearing of the last beam; by default, the beams cover a full turn without a duplicate.
        limits: `range_min` and `range_max`, in metres.
    """
    last = first_bearing + 360.0 * (beams - 1) / beams if last_bearing is None else last_bearing
    increment = math.radians(last - first_bearing) / (beams - 1)
    start = math.radians(first_bearing)
    message = LaserScan()
    message.header.frame_id = "laser"
    message.angle_min, message.angle_increment = start, increment
    message.angle_max = start + increment * (beams - 1)
    message.scan_time = 0.1
    message.range_min, message.range_max = limits
    bearings = [math.degrees(math.remainder(start + i * increment, math.tau)) for i in range(beams)]
    message.ranges = [_reading(bearing, parts, fill) for bearing in bearings]
    return message


def _reading(bearing: float, parts: Sequence[Part], fill: float) -> float:
    for part in reversed(parts):
        if part.first <= bearing <= part.last:
            return part.value
    return fill
