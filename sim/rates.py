"""Times of periodic events: multiples of the period from 0 on, whatever the length of the ticks."""

from __future__ import annotations

NANOSECONDS = 1_000_000_000


def due(before_ns: int, now_ns: int, rate: float) -> bool:
    """Return whether an event that happens `rate` times a second is due after `before_ns` and not after `now_ns`."""
    return int(now_ns * rate / NANOSECONDS + 1e-9) > int(before_ns * rate / NANOSECONDS + 1e-9)
