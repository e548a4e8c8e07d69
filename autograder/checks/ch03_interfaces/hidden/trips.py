"""Hidden trips: what is drawn of batteries, legs and reserves, all within the bounds of the contract."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from autograder.checks.ch03_interfaces.support.contract import MAX_LEGS, METRES_PER_PERCENT

# Percent that the charge has more than its whole level, and part of a percent that the legs take: whoever reckons with
# the charge itself comes to another whole number.
CHARGES = ((0.4, 0.2), (-0.4, 0.8)) * 2
MADE = 3  # legs that are made to measure


@dataclass(frozen=True)
class Trip:
    """A battery and a trip that it lasts for.

    Attributes:
        level: of the battery, in whole percent.
        over: percent that it has more than that, between -0.5 and 0.5.
        legs: in m.
    """

    level: int
    over: float
    legs: tuple[float, ...]

    def left(self, level: int) -> int:
        """Return what the legs leave of a level in percent, rounded down."""
        return math.floor(level - sum(self.legs) / METRES_PER_PERCENT)


@dataclass(frozen=True)
class Reserve:
    """A level of the battery, a reserve below it, both in percent, and the way of a short trip in m."""

    level: int
    reserve: int
    way: float

    @property
    def trips(self) -> tuple[list[float], ...]:
        """The legs in m of three trips, which take a whole number of percent, half a percent more, and nothing."""
        return [self.way], [self.way / 2, self.way / 2 + METRES_PER_PERCENT / 2], []


def draw_trips(draw: random.Random) -> list[Trip]:
    """Draw trips of one to eight legs that leave a part of a percent, which is rounded down."""
    return [_draw_trip(draw, over, share) for over, share in CHARGES]


def _draw_trip(draw: random.Random, over: float, share: float) -> Trip:
    legs = [draw.uniform(1.0, 20.0) for _ in range(draw.randint(1, MAX_LEGS - MADE))]
    legs += [draw.uniform(0.1, 0.9), 0.0]  # a leg may be short, and it may be none
    legs.append((share - sum(legs) / METRES_PER_PERCENT) % 1.0 * METRES_PER_PERCENT)
    return Trip(draw.randint(50, 100), over, tuple(legs))


def draw_reserves(draw: random.Random) -> list[Reserve]:
    """Draw two batteries with a reserve."""
    return [
        Reserve(draw.randint(60, 100), draw.randint(10, 39), draw.randint(1, 7) * METRES_PER_PERCENT) for _ in range(2)
    ]


def draw_too_far(draw: random.Random, level: int) -> tuple[list[float], list[float]]:
    """Draw the legs of a trip far too long for a level in percent, and of one that takes less than 1 % too much."""
    return [draw.uniform(300.0, 900.0), 50.0], [level * METRES_PER_PERCENT, draw.uniform(1.0, 4.0)]


def draw_bad_legs(draw: random.Random) -> list[tuple[float, list[float]]]:
    """Draw legs that are no distances, each with a trip in which it stands beside a right one."""
    trips = []
    for bad in (-draw.uniform(0.1, 0.9), -draw.uniform(1.5, 5.0), math.nan, math.inf):
        legs = [draw.uniform(1.0, 9.0), bad]
        draw.shuffle(legs)
        trips.append((bad, legs))
    return trips
