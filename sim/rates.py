"""When something that happens at a rate is due: on a grid that starts at 0, however long the ticks are."""

from __future__ import annotations

NANOSECONDS = 1_000_000_000


def due(before_ns: int, now_ns: int, rate: float) -> bool:
    """Say whether something that happens `rate` times a simulated second happens after `before_ns`, by `now_ns`."""
    return int(now_ns * rate / NANOSECONDS + 1e-9) > int(before_ns * rate / NANOSECONDS + 1e-9)
