"""Trips and batteries in plain numbers, without ROS."""

from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
import math


@dataclass(frozen=True)
class Verdict:
    """What came of a question about a trip."""

    left: int
    reason: str


def whole_percent(share):
    """Return a share from 0 to 1 in whole percent, halves up; None if it is no such share."""
    if math.isnan(share) or not 0.0 <= share <= 1.0:
        return None
    return int((Decimal(share) * 100).quantize(Decimal(1), rounding=ROUND_HALF_UP))


def judge(level, legs, reserve, metres_a_percent):
    """Return the verdict on a trip; level is None where it is unknown."""
    if level is None:
        return Verdict(-1, "the battery has not said its level")
    if not all(math.isfinite(leg) and leg >= 0.0 for leg in legs):
        return Verdict(-1, "a leg of this trip is no distance")
    needed = math.fsum(legs) / metres_a_percent
    left = max(0, math.floor(level - needed))
    if needed > level:
        return Verdict(left, f"it takes {needed:.0f} percent, and there are {level}")
    return Verdict(left, "" if left >= reserve else f"{reserve} percent must be left, not {left}")
