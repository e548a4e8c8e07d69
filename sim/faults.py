"""What can go wrong with a lidar, as values switched on for windows of simulated time."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Window:
    """From `start` (inclusive) to `end` (exclusive), in seconds of simulated time."""

    start: float = 0.0
    end: float = math.inf


ALWAYS = Window()


@dataclass(frozen=True, slots=True)
class DeadSector:
    """The beams from the angle `first` anticlockwise to `last` (radians, frame `laser`) read nan in `window`."""

    first: float
    last: float
    window: Window = ALWAYS


@dataclass(frozen=True, slots=True)
class Faults:
    """The faults of one robot's lidar.

    In a `dead` window it sends nothing at all; in a `frozen` one it sends the scan of the window's start again and
    again, each with a new stamp; a `DeadSector` is blind.
    """

    dead: tuple[Window, ...] = ()
    frozen: tuple[Window, ...] = ()
    sectors: tuple[DeadSector, ...] = ()


NO_FAULTS = Faults()
