"""How far simulated time goes on at a moment of real time. No ROS and no clock in here."""

from __future__ import annotations

PERIOD = 0.01
"""Seconds of real time between two looks at the clock."""

LONGEST_LEAP = 0.25
"""Seconds of real time made up for. A machine that sleeps must not make the robot leap."""

AT_ONCE = 0.1
"""Seconds of simulated time made up for between two looks at the commands: less than a robot's watchdog waits."""


class Pace:
    """Lets simulated time follow real time. Time begins with the first look.

    `late` says whether the last look found more time passed than is made up for; the rest is forgotten.
    """

    def __init__(self, tick: float) -> None:
        """Begin with nothing to make up for; `tick` is the physics period in s."""
        self.late = False
        self._tick = tick
        self._last: float | None = None
        self._behind = 0.0

    def due(self, now: float, speed: float, paused: bool = False) -> float:
        """Return how much simulated time, in s, may go on now; the caller says by `went_on` how much did.

        Args:
            now: real time in s.
            speed: simulated seconds in a second of real time.
            paused: whether the time since the last look does not count.
        """
        passed, self._last = 0.0 if self._last is None else now - self._last, now
        if paused:
            return 0.0
        self._behind += passed * speed
        longest = LONGEST_LEAP * speed + self._tick
        self.late = self._behind > longest
        self._behind = min(self._behind, longest)
        return min(self._behind, max(AT_ONCE, 2.0 * PERIOD * speed, self._tick))

    def went_on(self, seconds: float) -> None:
        """Take note that so much simulated time has gone on."""
        self._behind -= seconds

    def forget(self) -> None:
        """Make up for nothing that is past."""
        self._behind = 0.0
