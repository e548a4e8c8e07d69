"""Batteries and trips of all kinds that the contract allows, and the answers that it requires."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hypothesis import strategies as st

from autograder.checks.ch03_interfaces.support.contract import MAX_LEGS, METRES_PER_PERCENT, RESERVE, UNKNOWN

ROUNDING = 1e-6  # percent: far more than the order in which the legs are added up can change
EIGHTH = METRES_PER_PERCENT / 8  # m; legs that are whole multiples of it are added up exactly
ENOUGH = 51  # percent: more than SHORT_LEGS take, even if a program rounds the level down
FULL_LEGS = (100.125,) * MAX_LEGS  # m; a text that lists them is longer than a reason may be


@dataclass(frozen=True)
class Trip:
    """A battery's charge and a trip.

    Attributes:
        level: the battery's level, in whole percent.
        excess: the charge minus the level in percent, between -0.5 and 0.5.
        legs: the lengths of the legs, in m.
        reserve: the charge that must remain at the end of the trip, in percent.
    """

    level: int
    legs: tuple[float, ...]
    reserve: int = 0
    excess: float = 0.0

    def __repr__(self) -> str:
        legs = f"legs of {', '.join(f'{leg:.6g}' for leg in self.legs)} m" if self.legs else "no legs"
        return f"at {self.level} %, with {legs} and a reserve of {self.reserve} %"


def answers(level: int, legs: tuple[float, ...], reserve: int) -> set[tuple[bool, int]]:
    """Return whether a trip is possible, and the percent at its end: more than one pair if rounding errors decide."""
    if level == UNKNOWN or not all(0.0 <= leg < math.inf for leg in legs):
        return {(False, UNKNOWN)}
    charge_left = level - math.fsum(legs) / METRES_PER_PERCENT
    rounding = 0.0 if all(leg % EIGHTH == 0.0 for leg in legs) else ROUNDING
    charges = (charge_left - rounding, charge_left + rounding)
    ends = {(charge >= 0.0, math.floor(max(0.0, charge))) for charge in charges}
    return {(lasts and at_end >= reserve, at_end) for lasts, at_end in ends}


def whole_percents(percentage: float) -> set[int]:
    """Return the correct levels of a battery state, with halves rounded up: two levels if rounding errors decide."""
    if not 0.0 <= percentage <= 1.0:
        return {UNKNOWN}
    percent = percentage * 100.0
    is_exact = percentage * 8.0 % 1.0 == 0.0
    return {math.floor(percent + 0.5 + error) for error in ((0.0,) if is_exact else (-1e-4, 1e-4))}


# Multiples of 0.001, half percents that float32 represents exactly, and 0.01 percent below or above a half.
PERCENTAGES = (
    st.integers(0, 1000).map(lambda number: number / 1000)
    | st.sampled_from((0.125, 0.375, 0.625, 0.875))
    | st.builds(lambda level, excess: (level + excess) / 100.0, st.integers(0, 99), st.sampled_from((0.49, 0.51)))
)
INVALID_PERCENTAGES = st.sampled_from(
    (math.nan, math.inf, -math.inf, 1.00001, -0.00001, 1.004, -0.004, 1.5, -0.5, 85.0, 100.0)
)
_EXACT_LEG = st.integers(1, 40).map(lambda number: number * EIGHTH)
_LEG = _EXACT_LEG | st.integers(0, 2500).map(lambda number: number / 100)
SHORT_LEGS = (st.lists(_LEG, max_size=4) | st.lists(_LEG, min_size=MAX_LEGS, max_size=MAX_LEGS)).map(tuple)
_INVALID_LEG = st.sampled_from((math.nan, math.inf, -math.inf, -0.001, -0.5, -5.0, -100.0))


def short_trips() -> st.SearchStrategy[Trip]:
    """Draw trips for which the battery lasts."""
    return st.builds(Trip, st.integers(ENOUGH, 100), SHORT_LEGS, st.just(0), st.sampled_from((0.0, 0.4, -0.4, 0.25)))


@st.composite
def reserves(draw: st.DrawFn) -> tuple[tuple[float, ...], int]:
    """Draw legs, and by how many percent the reserve exceeds what they leave: about 0, or any number."""
    return draw(st.lists(_EXACT_LEG, max_size=MAX_LEGS).map(tuple)), draw(
        st.sampled_from((0, 1, -1)) | st.integers(-200, 200) | st.just(-(10**9))
    )


@st.composite
def long_legs(draw: st.DrawFn, level: int) -> tuple[float, ...]:
    """Draw legs that take more than `level` percent of the charge: hardly more, or far more."""
    excess = draw(st.sampled_from((0.25, 2.5, 4.375, 5.0, 500.0, 1e6)))
    legs = draw(st.lists(st.integers(0, 8 * level // MAX_LEGS).map(lambda n: n * EIGHTH), max_size=MAX_LEGS - 2))
    return (*legs, level * METRES_PER_PERCENT - sum(legs), excess)


@st.composite
def wrong_legs(draw: st.DrawFn) -> tuple[float, ...]:
    """Draw legs of which at least one is not a distance."""
    legs = draw(st.lists(_LEG | _INVALID_LEG, max_size=MAX_LEGS - 1))
    legs.insert(draw(st.integers(0, len(legs))), draw(_INVALID_LEG))
    return tuple(legs)


def any_trips(level: int) -> st.SearchStrategy[Trip]:
    """Draw trips of any kind for a level, most of them with a reserve of 20 percent."""
    legs = SHORT_LEGS | long_legs(level) | wrong_legs() | st.just(FULL_LEGS)
    return st.builds(Trip, st.just(level), legs, st.just(RESERVE) | st.integers(-(2**31), 2**31 - 1))
