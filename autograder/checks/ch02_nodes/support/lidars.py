"""Lidars that differ from the usual one in their first bearing, their direction or their field of view."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass

from sensor_msgs.msg import LaserScan

from autograder.checks.ch02_nodes.support.scans import Part, scan

TURN = 360.0  # degrees
USUAL_BEAMS = 360  # of the lidar that the other checks use
MIN_BEAMS, MAX_BEAMS = 500, 800
HALF_WIDTH = 3.0  # degrees to each side of an obstacle's bearing: several beams of any of these lidars


@dataclass(frozen=True)
class Lidar:
    """A lidar's number of beams, and the unwrapped bearings of its first and last beam in degrees."""

    beams: int
    first: float
    last: float

    def __str__(self) -> str:
        return f"a lidar of {self.beams} beams from {self.first:.0f}° to {self.last:.0f}°"

    def scan(self, *parts: Part, fill: float = 3.0) -> LaserScan:
        """Return a scan of this lidar; see `scans.scan`."""
        return scan(*parts, fill=fill, beams=self.beams, first_bearing=self.first, last_bearing=self.last)

    def unwrapped_bearings(self, bearing: float) -> Iterator[float]:
        """Yield the unwrapped bearings of a direction, in degrees; a scan of more than a turn may have two."""
        low, high = sorted((self.first, self.last))
        turns = range(
            math.ceil((low + HALF_WIDTH - bearing) / TURN), math.floor((high - HALF_WIDTH - bearing) / TURN) + 1
        )
        yield from (bearing + TURN * number for number in turns)

    def scan_of_one(self, bearing: float, distance: float, fill: float = 3.0) -> LaserScan:
        """Return a scan of one obstacle at a distance in metres, which the beams around an unwrapped bearing read."""
        step = (self.last - self.first) / (self.beams - 1)
        message = self.scan(fill=fill)
        offsets = [abs(self.first + number * step - bearing) for number in range(self.beams)]
        message.ranges = [distance if degrees <= HALF_WIDTH else fill for degrees in offsets]
        return message


def other_lidars(draw: random.Random) -> tuple[Lidar, ...]:
    """Draw lidars with any first bearing and either direction, some of them turns away or longer than a turn.

    The first three have as many beams as the usual lidar, so bearings that a robot caches by this number are wrong.
    """
    turns, ahead, beam_count = (
        draw.choice((-3, -2, 2, 3)) * TURN,
        draw.uniform(-25.0, 25.0),
        draw.randrange(MIN_BEAMS, MAX_BEAMS),
    )
    first = draw.uniform(-700.0, -380.0)
    upside_down = TURN * (1 - USUAL_BEAMS) / USUAL_BEAMS
    return (
        Lidar(USUAL_BEAMS, -180.0, 179.0),
        Lidar(USUAL_BEAMS, 0.0, upside_down),
        Lidar(USUAL_BEAMS, ahead, ahead + TURN - 1.0),
        Lidar(beam_count, turns + 180.0, turns - 179.0),
        Lidar(beam_count, first, first + 1.7 * TURN),
    )
