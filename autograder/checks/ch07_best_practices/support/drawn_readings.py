"""Readings of any lidar that the contract allows, and what the utilities should return for them."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, isfinite, isinf, isnan, nan
from statistics import fmean
from typing import Any, TypeVar

from hypothesis import strategies as st

from autograder.checking import CheckFailed
from autograder.checking.drawn_cases import expect_each

LOW, HIGH = 0.2, 6.0  # m: the limits of a usual lidar
BEYOND_LIMIT = 1e-4  # m beyond a limit, more than a rounding error
DEFAULT_HISTORY = 100  # scans
MAX_SCANS = 12  # the largest number of scans in a series
SHOWN_SCANS = 7  # the largest number of scans that a message shows
BLIND: tuple[list[float], ...] = ([nan], [], [inf], [-inf, nan], [inf, 0.0])  # scans without a distance

Case = TypeVar("Case")


@dataclass(frozen=True)
class Readings:
    """The readings of one scan and the limits of its lidar, in metres."""

    readings: tuple[float, ...]
    low: float = LOW
    high: float = HIGH

    @property
    def masked(self) -> list[float]:
        """Requirement: infinities stay, a number within the limits stays, everything else becomes nan."""
        return [each if isinf(each) or self.low <= each <= self.high else nan for each in self.readings]

    @property
    def is_usual(self) -> bool:
        """Whether the lidar is the usual one."""
        return (self.low, self.high) == (LOW, HIGH)

    def distance_beyond_limits(self, reading: float) -> float:
        """Return by how many metres a reading is beyond the limits, negative if it is within them."""
        return max(self.low - reading, reading - self.high)

    @property
    def call(self) -> str:
        """The call of mask_invalid, as a student would write it."""
        return f"mask_invalid({self!r})"

    def __repr__(self) -> str:
        return f"{list(self.readings)}, {self.low}, {self.high}"


@dataclass(frozen=True)
class Series:
    """Scans that one DataProcessor processes in a row, and its `history`, or None for the default."""

    scans: tuple[Readings, ...]
    history: int | None

    @property
    def arguments(self) -> tuple[int, ...]:
        """The arguments of DataProcessor."""
        return () if self.history is None else (self.history,)

    @property
    def constructor(self) -> str:
        """The call of DataProcessor."""
        return f"DataProcessor({self.history or ''})"

    def describe_first(self, count: int) -> str:
        """Describe the first `count` scans."""
        shown_scans = ", ".join(str(list(scan.readings)) for scan in self.scans[max(0, count - SHOWN_SCANS) : count])
        return f"{count} scan{'s' * (count > 1)} ({'the newest are ' * (count > SHOWN_SCANS)}{shown_scans})"


def kept_readings(masked: list[Any]) -> list[float]:
    """Return the numbers that are not masked, in ascending order. Another check tests their order in the list."""
    return sorted(reading for reading in masked if isinstance(reading, int | float) and not isnan(reading))


def mean_of(readings: Iterable[float]) -> float | None:
    """Requirement: the mean of the finite readings; None if there is none."""
    finite = [each for each in readings if isfinite(each)]
    return fmean(finite) if finite else None


def averages(case: Series) -> list[float | None]:
    """Requirement: after each scan, the mean of the newest `history` means. A scan without a mean does not count."""
    means = [mean_of(scan.masked) for scan in case.scans]
    known_means = ([mean for mean in means[:count] if mean is not None] for count in range(1, len(means) + 1))
    return [mean_of(each[-(case.history or DEFAULT_HISTORY) :]) for each in known_means]


# Strategies.


def distances_between(low: float, high: float) -> st.SearchStrategy[float]:
    """Draw a distance in whole millimetres, strictly between two distances."""
    return st.integers(round(low * 1000) + 1, round(high * 1000) - 1).map(lambda number: number / 1000)


GOOD = distances_between(LOW, HIGH)
# Plain numbers that the usual lidar cannot have measured.
PLAIN_PHANTOMS = (0.0, nan, 50.0, -1.0, -0.0, 1e9)
PHANTOMS = st.sampled_from(PLAIN_PHANTOMS) | distances_between(0.0, LOW) | distances_between(HIGH, 2 * HIGH)


def scans_of(
    readings: st.SearchStrategy[float], *, min_size: int = 0, low: float = LOW, high: float = HIGH
) -> st.SearchStrategy[Readings]:
    """Draw scans of these readings."""
    return st.lists(readings, min_size=min_size, max_size=10).map(lambda each: Readings(tuple(each), low, high))


@st.composite
def other_lidars(draw: st.DrawFn, *, at_limits: bool) -> Readings:
    """Draw readings of a lidar with any limits: exactly at the limits, or around them."""
    if at_limits:
        low, high = draw(distances_between(0.1, 2.0)), draw(distances_between(3.0, 9.0))
        return Readings((*draw(st.lists(distances_between(low, high), max_size=4)), low, high), low, high)
    low = draw(st.sampled_from((LOW, 0.0)) | distances_between(0.0, 2.0))
    high = round(low + draw(distances_between(0.5, 5.0) | distances_between(5.0, 60.0)), 3)
    near = [round(limit + step, 4) for limit in (low, high) for step in (-BEYOND_LIMIT, BEYOND_LIMIT)]
    readings = st.sampled_from((*near, low - 1.0, high + 1.0)) | distances_between(low, high)
    return Readings(tuple(draw(st.lists(readings, min_size=1, max_size=8))), low, high)


@st.composite
def lists_with_a_mean(draw: st.DrawFn) -> list[float]:
    """Draw readings of which at least one is finite."""
    number = distances_between(-5.0, 60.0) | st.sampled_from((0.0, 1.0, -1.0))
    other = st.sampled_from((nan, inf, -inf))
    readings = draw(st.lists(number | other, max_size=12))
    readings.insert(draw(st.integers(0, len(readings))), draw(number))
    return readings


# Scans whose beams all measure the same distance; a scan whose distance is 0 m; and scans without a distance.
ONE_BEAM = GOOD.map(lambda reading: Readings((reading,)))
GOOD_SCANS = st.builds(lambda reading, beams: Readings((reading,) * beams), GOOD, st.integers(1, 4))
AT_ZERO = Readings((0.0,), low=-1.0)
BLIND_SCANS = st.sampled_from([Readings(tuple(readings)) for readings in BLIND])


def series(scans: st.SearchStrategy[Readings], history: st.SearchStrategy[int]) -> st.SearchStrategy[Series]:
    """Draw scans that are processed in a row."""
    return st.builds(Series, st.lists(scans, min_size=1, max_size=MAX_SCANS).map(tuple), history)


# Judging.


def draw_cases(strategy: st.SearchStrategy[Case], draw: random.Random, count: int) -> list[Case]:
    """Draw cases that will all run in one process."""
    cases: list[Case] = []
    expect_each(strategy, cases.append, draw, count=count)
    return cases


def expect_all(cases: Iterable[Case], judge: Callable[[Case], None]) -> None:
    """Judge all cases; raise the failure that costs most, with the shortest message if several cost the same."""
    failures = []
    for case in cases:
        try:
            judge(case)
        except CheckFailed as failure:
            failures.append(failure)
    if failures:
        raise min(failures, key=lambda failure: (failure.fraction, len(failure.message)))
