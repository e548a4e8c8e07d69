"""The length of a step of ROS time: the limits and rules that all harnesses share."""

from __future__ import annotations

import math
from collections.abc import Iterable

# The longest and the shortest step have to divide `drive.SCAN_NS`, because a scan is sent at the end of a step.
TICK_NS = 100_000_000  # the longest step that `Harness.run` takes
FINEST_TICK_NS = 10_000_000  # the shortest step, even if the programs' timers are faster
SLACK_NS = 1_000_000  # a wake-up at most this long before the end of a step is postponed to its end


def tick_of(tick_ns: int, timers: Iterable[int]) -> int:
    """Return the longest step up to `tick_ns` for which timers with these periods in ns fire only at the end of a step.

    The step is not shorter than `FINEST_TICK_NS`, even if timers then fire within it.
    """
    return max(FINEST_TICK_NS, math.gcd(tick_ns, *timers))


def next_instant(now_ns: int, end_ns: int, wakes: Iterable[int | None]) -> int:
    """Return the instant up to which programs can be stepped in one go.

    Args:
        now_ns: the current ROS time.
        end_ns: the end of the step.
        wakes: for each program, the next time at which it wakes up for anything but a timer, or None.

    Returns:
        The first wake-up in the step, or the end of the step.
    """
    earliest = now_ns + FINEST_TICK_NS
    possible_wakes = (max(wake, earliest) for wake in wakes if wake is not None)
    return min((wake for wake in possible_wakes if wake < end_ns - SLACK_NS), default=end_ns)
