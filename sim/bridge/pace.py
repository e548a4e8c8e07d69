"""Computes how much simulated time is due at an instant of real time. It needs neither ROS nor a clock."""

from __future__ import annotations

PERIOD = 0.01
"""Seconds of real time between two calls of the timer."""

MAX_BACKLOG = 0.25
"""The longest delay that is caught up, in s of real time, so that a robot does not jump after its machine has slept."""

MAX_BATCH = 0.1
"""The longest time simulated before commands are received again, in s: less than the time of a robot's watchdog."""


class Pace:
    """Lets simulated time follow real time. Time begins with the first call of `due`.

    `is_late` is true if more time had passed at the last call than can be caught up. The excess is dropped.
    """

    def __init__(self, tick: float) -> None:
        """Begin without a backlog; `tick` is the physics period in s."""
        self.is_late = False
        self._tick = tick
        self._last_call: float | None = None
        self._backlog = 0.0

    def due(self, now: float, speed: float, paused: bool = False) -> float:
        """Return how much simulated time, in s, is due now. The caller reports how much of it has been simulated.

        Args:
            now: the real time in s.
            speed: simulated seconds per second of real time.
            paused: whether to ignore the time since the last call.
        """
        elapsed, self._last_call = 0.0 if self._last_call is None else now - self._last_call, now
        if paused:
            return 0.0
        self._backlog += elapsed * speed
        max_backlog = MAX_BACKLOG * speed + self._tick
        self.is_late = self._backlog > max_backlog
        self._backlog = min(self._backlog, max_backlog)
        return min(self._backlog, max(MAX_BATCH, 2.0 * PERIOD * speed, self._tick))

    def count_simulated(self, seconds: float) -> None:
        """Subtract simulated time from the backlog."""
        self._backlog -= seconds

    def clear(self) -> None:
        """Drop the backlog."""
        self._backlog = 0.0
