"""Lidars that differ from the usual one, by where they begin, which way round they count, and how far."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass

from sensor_msgs.msg import LaserScan

from autograder.checks.ch02_nodes.support.scans import Part, scan

TURN = 360.0  # degrees
USUAL_BEAMS = 360  # of the lidar that the other checks show
MANY, MOST = 500, 800  # beams
WIDE = 3.0  # degrees to each side of what is seen: several beams of any of these lidars


@dataclass(frozen=True)
class Lidar:
    """A lidar of so many beams, the first and the last of which have these bearings, in degrees; not wrapped."""

    beams: int
    first: float
    last: float

    def __str__(self) -> str:
        return f"a lidar of {self.beams} beams from {self.first:.0f}° to {self.last:.0f}°"

    def scan(self, *parts: Part, fill: float = 3.0) -> LaserScan:
        """Return its scan; see `scans.scan`."""
        return scan(*parts, fill=fill, beams=self.beams, first_bearing=self.first, last_bearing=self.last)

    def sees(self, bearing: float) -> Iterator[float]:
        """Yield each bearing, not wrapped, at which it looks in a direction, in degrees; a long scan does so twice."""
        low, high = sorted((self.first, self.last))
        turns = range(math.ceil((low + WIDE - bearing) / TURN), math.floor((high - WIDE - bearing) / TURN) + 1)
        yield from (bearing + TURN * number for number in turns)

    def scan_of_one(self, bearing: float, distance: float, fill: float = 3.0) -> LaserScan:
        """Return its scan of one thing, so many metres away, that the beams around one bearing, not wrapped, show."""
        step = (self.last - self.first) / (self.beams - 1)
        shown = self.scan(fill=fill)
        away = [abs(self.first + number * step - bearing) for number in range(self.beams)]
        shown.ranges = [distance if degrees <= WIDE else fill for degrees in away]
        return shown


def other_lidars(draw: random.Random) -> tuple[Lidar, ...]:
    """Return lidars of all kinds: any first bearing, either way round, up to some turns away and over more than one.

    The first ones have as many beams as the usual one: who remembers bearings by that number errs.
    """
    turns, ahead, many = draw.choice((-3, -2, 2, 3)) * TURN, draw.uniform(-25.0, 25.0), draw.randrange(MANY, MOST)
    begins = draw.uniform(-700.0, -380.0)
    upside_down = TURN * (1 - USUAL_BEAMS) / USUAL_BEAMS
    return (
        Lidar(USUAL_BEAMS, -180.0, 179.0),
        Lidar(USUAL_BEAMS, 0.0, upside_down),
        Lidar(USUAL_BEAMS, ahead, ahead + TURN - 1.0),
        Lidar(many, turns + 180.0, turns - 179.0),
        Lidar(many, begins, begins + 1.7 * TURN),
    )
