"""Faults of a lidar, each of which lasts for a window of simulated time."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.exceptions import SpecError


@dataclass(frozen=True, slots=True)
class Window:
    """A window of simulated time from `start` (inclusive) to `end` (exclusive), in seconds."""

    start: float = 0.0
    end: float = math.inf

    def __post_init__(self) -> None:
        if not (0.0 <= self.start < self.end):
            raise SpecError(
                f"a window from {self.start} s to {self.end} s is invalid; give a start of 0 or more and a later end"
            )

    def holds(self, time_ns: int) -> bool:
        """Return whether a simulated time in nanoseconds is within the window."""
        return self.start <= time_ns / 1e9 < self.end


ALWAYS = Window()


@dataclass(frozen=True, slots=True)
class DeadSector:
    """The beams from the angle `first` anticlockwise to `last` (radians, frame `laser`) read nan in `window`."""

    first: float
    last: float
    window: Window = ALWAYS

    def __post_init__(self) -> None:
        if not (math.isfinite(self.first) and math.isfinite(self.last)):
            raise SpecError(
                f"a dead sector from {self.first} to {self.last} is invalid; give two finite angles in radians"
            )

    @property
    def width(self) -> float:
        """The width in radians: a whole turn if `last` is at least a turn beyond `first`."""
        width = self.last - self.first
        return width if width >= math.tau else width % math.tau


@dataclass(frozen=True, slots=True)
class Faults:
    """The faults of one robot's lidar.

    In a `dead` window, the lidar sends nothing. In a `frozen` one, it repeats the scan from the start of the
    window, each time with a new stamp. In a `DeadSector`, it measures nothing.
    """

    dead: tuple[Window, ...] = ()
    frozen: tuple[Window, ...] = ()
    sectors: tuple[DeadSector, ...] = ()


NO_FAULTS = Faults()
