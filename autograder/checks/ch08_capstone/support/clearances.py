"""The right clearance of a scan, by the sentences of step 2: what a controller is told that is judged alone."""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import LaserScan

from autograder.checks.ch08_capstone.support.contract import PARAMETERS, PROCESSOR

MIDDLES = {"front": 0.0, "left": math.pi / 2, "right": -math.pi / 2}  # rad
HALF_ANGLE = PARAMETERS[PROCESSOR]["half_angle"].default


def right_clearance(kind: type, scan: LaserScan) -> Any:
    """Return the clearance, a message of this type, that belongs to a scan; its header is the scan's own."""
    distances = {name: nearest(scan, middle) for name, middle in MIDDLES.items()}
    return kind(header=scan.header, valid=not any(map(math.isnan, distances.values())), **distances)


def nearest(scan: LaserScan, middle: float, half_angle: float = HALF_ANGLE) -> float:
    """Return the nearest reading that counts within `half_angle` of `middle`, in metres; nan if none does."""
    readings = [
        float(reading)
        for index, reading in enumerate(scan.ranges)
        if abs(math.remainder(scan.angle_min + index * scan.angle_increment - middle, math.tau)) <= half_angle
        and (math.isinf(reading) or scan.range_min <= reading <= scan.range_max)
    ]
    return min(readings, default=math.nan)
