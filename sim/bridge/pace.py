"""Computes how much simulated time is due at an instant of real time, without ROS or a clock."""

from __future__ import annotations

PERIOD = 0.01
"""Seconds of real time between two calls of the timer."""

MAX_BACKLOG = 0.25
"""Seconds of real time that can be caught up, so that a robot does not jump after its machine has slept."""

MAX_BATCH = 0.1
"""Seconds of simulated time caught up before commands are received again: less than the time of a robot's watchdog."""


class Pace:
    """Lets simulated time follow real time. Time begins with the first call of `due`.

    `is_late` says whether more time had passed at the last call than can be caught up. The excess is dropped.
    """

    def __init__(self, tick: float) -> None:
        """Begin without a backlog; `tick` is the physics period in s."""
        self.is_late = False
        self._tick = tick
        self._last: float | None = None
        self._behind = 0.0

    def due(self, now: float, speed: float, paused: bool = False) -> float:
        """Return how much simulated time, in s, is due now. The caller reports the simulated part of it.

        Args:
            now: the real time in s.
            speed: simulated seconds in a second of real time.
            paused: whether the time since the last call does not count.
        """
        elapsed, self._last = 0.0 if self._last is None else now - self._last, now
        if paused:
            return 0.0
        self._behind += elapsed * speed
        max_behind = MAX_BACKLOG * speed + self._tick
        self.is_late = self._behind > max_behind
        self._behind = min(self._behind, max_behind)
        return min(self._behind, max(MAX_BATCH, 2.0 * PERIOD * speed, self._tick))

    def count_simulated(self, seconds: float) -> None:
        """Subtract simulated time from the backlog."""
        self._behind -= seconds

    def clear(self) -> None:
        """Drop the backlog."""
        self._behind = 0.0
