"""The clearance that step 2 of the notebook requires for a scan, for a controller that is tested alone."""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import LaserScan

from autograder.checks.ch08_capstone.support.contract import PARAMETERS, PROCESSOR

MIDDLES = {"front": 0.0, "left": math.pi / 2, "right": -math.pi / 2}  # rad: the middles of the sectors
HALF_ANGLE = PARAMETERS[PROCESSOR]["half_angle"].default


def expected_clearance(message_type: type, scan: LaserScan) -> Any:
    """Return the expected clearance of a scan as a message of this type, with the scan's header."""
    distances = {name: nearest(scan, middle) for name, middle in MIDDLES.items()}
    return message_type(header=scan.header, valid=not any(map(math.isnan, distances.values())), **distances)


def nearest(scan: LaserScan, middle: float, half_angle: float = HALF_ANGLE) -> float:
    """Return the nearest valid reading within `half_angle` of `middle`, in metres; nan if there is none."""
    readings = [
        float(reading)
        for index, reading in enumerate(scan.ranges)
        if abs(math.remainder(scan.angle_min + index * scan.angle_increment - middle, math.tau)) <= half_angle
        and (math.isinf(reading) or scan.range_min <= reading <= scan.range_max)
    ]
    return min(readings, default=math.nan)
