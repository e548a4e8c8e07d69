"""How long a step of ROS time is: the constants and the rules, for every harness."""

from __future__ import annotations

import math
from collections.abc import Iterable

# Both have to divide `drive.SCAN_NS`: a scan is sent where a step ends.
TICK_NS = 100_000_000  # the longest step that `Harness.run` takes
FINEST_TICK_NS = 10_000_000  # the shortest, however short the programs' timers are
SLACK_NS = 1_000_000  # a program that wants to wake so shortly before the end of a step wakes at its end


def tick_of(tick_ns: int, timers: Iterable[int]) -> int:
    """Return the longest step up to `tick_ns` that hits every firing of timers, by their periods in ns."""
    return max(FINEST_TICK_NS, math.gcd(tick_ns, *timers))


def next_instant(now_ns: int, end_ns: int, wakes: Iterable[int | None]) -> int:
    """Return the instant up to which programs can be stepped at once.

    Args:
        now_ns: the present ROS time.
        end_ns: the end of the step.
        wakes: when each program wants to continue besides its timers; None for one that does not.

    Returns:
        The first of the wakes in the step, or the end of the step.
    """
    earliest = now_ns + FINEST_TICK_NS
    later = (max(wake, earliest) for wake in wakes if wake is not None)
    return min((wake for wake in later if wake < end_ns - SLACK_NS), default=end_ns)
