"""Draws hidden trips: batteries, legs and reserves within the bounds of the contract."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from autograder.checks.ch03_interfaces.support.contract import MAX_LEGS, METRES_PER_PERCENT

# The charge minus the whole level in percent, and the part of a percent that the legs take. A program that computes
# with the charge instead of the level gets another whole number.
CHARGES = ((0.4, 0.2), (-0.4, 0.8)) * 2
FIXED_LEGS = 3  # legs that are not drawn freely


@dataclass(frozen=True)
class Trip:
    """A battery and a trip that it lasts for.

    Attributes:
        level: the battery's level, in whole percent.
        excess: the charge minus the level in percent, between -0.5 and 0.5.
        legs: the lengths of the legs, in m.
    """

    level: int
    excess: float
    legs: tuple[float, ...]

    def level_at_end(self, level: int) -> int:
        """Return the level after the legs in percent, rounded down."""
        return math.floor(level - sum(self.legs) / METRES_PER_PERCENT)


@dataclass(frozen=True)
class Reserve:
    """A battery's level, a reserve below it, both in percent, and the length of a short trip in m."""

    level: int
    reserve: int
    length: float

    @property
    def trips(self) -> tuple[list[float], ...]:
        """The legs in m of three trips, which take a whole number of percent, half a percent more, and nothing."""
        return [self.length], [self.length / 2, self.length / 2 + METRES_PER_PERCENT / 2], []


def draw_trips(draw: random.Random) -> list[Trip]:
    """Draw trips of up to eight legs that end with a part of a percent, which is rounded down."""
    return [_draw_trip(draw, excess, share) for excess, share in CHARGES]


def _draw_trip(draw: random.Random, excess: float, share: float) -> Trip:
    legs = [draw.uniform(1.0, 20.0) for _ in range(draw.randint(1, MAX_LEGS - FIXED_LEGS))]
    legs += [draw.uniform(0.1, 0.9), 0.0]  # a leg may be short, and it may be 0 m long
    legs.append((share - sum(legs) / METRES_PER_PERCENT) % 1.0 * METRES_PER_PERCENT)
    return Trip(draw.randint(50, 100), excess, tuple(legs))


def draw_reserves(draw: random.Random) -> list[Reserve]:
    """Draw two batteries with a reserve."""
    return [
        Reserve(draw.randint(60, 100), draw.randint(10, 39), draw.randint(1, 7) * METRES_PER_PERCENT) for _ in range(2)
    ]


def draw_too_far(draw: random.Random, level: int) -> tuple[list[float], list[float]]:
    """Draw the legs of a trip far too long for a level in percent, and of one that takes less than 1 % too much."""
    return [draw.uniform(300.0, 900.0), 50.0], [level * METRES_PER_PERCENT, draw.uniform(1.0, 4.0)]


def draw_bad_legs(draw: random.Random) -> list[tuple[float, list[float]]]:
    """Draw invalid legs, each with a trip that also contains a valid leg."""
    trips = []
    for bad in (-draw.uniform(0.1, 0.9), -draw.uniform(1.5, 5.0), math.nan, math.inf):
        legs = [draw.uniform(1.0, 9.0), bad]
        draw.shuffle(legs)
        trips.append((bad, legs))
    return trips
