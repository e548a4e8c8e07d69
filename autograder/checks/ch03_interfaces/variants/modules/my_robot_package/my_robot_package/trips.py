"""Trips and batteries in plain numbers, without ROS."""

from dataclasses import dataclass
from decimal import ROUND_HALF_UP, Decimal
import math


@dataclass(frozen=True)
class Verdict:
    """The answer to a question about a trip: the level at its end, and why it is not possible."""

    at_end: int
    reason: str


def whole_percent(share):
    """Return a share from 0 to 1 in whole percent, halves rounded up, or None for other numbers."""
    if math.isnan(share) or not 0.0 <= share <= 1.0:
        return None
    return int((Decimal(share) * 100).quantize(Decimal(1), rounding=ROUND_HALF_UP))


def check_trip(level, legs, reserve, metres_per_percent):
    """Return the verdict on a trip; an unknown level is None."""
    if level is None:
        return Verdict(-1, "the battery has not said its level")
    if not all(math.isfinite(leg) and leg >= 0.0 for leg in legs):
        return Verdict(-1, "a leg of this trip is no distance")
    needed = math.fsum(legs) / metres_per_percent
    at_end = max(0, math.floor(level - needed))
    if needed > level:
        return Verdict(at_end, f"it takes {needed:.0f} percent, and there are {level}")
    return Verdict(at_end, "" if at_end >= reserve else f"{reserve} percent must be left, not {at_end}")
