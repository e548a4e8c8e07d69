"""Temperatures drawn from all that the contract allows, and checks of how the nodes react to them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from random import Random
from statistics import fmean

from hypothesis import strategies as st

from autograder.checking import LOCKSTEP, expect
from autograder.checking.drawn_cases import expect_each
from autograder.checks.ch09_assessment.hidden.expectations import expect_decisions
from autograder.checks.ch09_assessment.support.contract import COOL, HOT, TOLERANCE, windows
from autograder.checks.ch09_assessment.support.robot import MESSAGE_SECONDS, NodeHarness

LOCKSTEP_PERIOD = 0.02  # s between two temperatures in lockstep
LENGTH = 7  # the largest number of temperatures in a series
FLOAT32 = 1e-5  # as a share of the largest number in a window: the precision of a sum of numbers in messages
UNKNOWN = (math.nan, math.inf, -math.inf)  # after these, the temperature is not known
Temperatures = st.SearchStrategy[list[float]]


def series(*edges: float, low: float = 20.0, high: float = 80.0) -> Temperatures:
    """Draw temperatures between two limits, with frequent repetitions of the limits and of these edges."""
    tenths = st.integers(round(10 * low), round(10 * high)).map(lambda number: number / 10)
    return st.lists(st.sampled_from((*edges, low, high)) | tenths, min_size=3, max_size=LENGTH)


def around_thresholds(*edges: float, hot: float = HOT, cool: float = COOL) -> Temperatures:
    """Draw temperatures around two thresholds, in any order. The first one sets the fan, whatever its state was."""
    between = st.floats(cool + 1.0, hot - 1.0).map(lambda celsius: round(celsius, 2))
    decisive = (cool - 5.0, hot + 5.0)
    rest = st.lists(between, min_size=2, max_size=2).flatmap(lambda drawn: st.permutations([*edges, *decisive, *drawn]))
    return st.tuples(st.sampled_from(decisive), rest).map(lambda parts: [parts[0], *parts[1]])


def expect_series(
    harness: NodeHarness, drawn: Temperatures, window: int, draw: Random, readings: list[float], *, fraction: float
) -> None:
    """Fail the check unless a smoother averages each of these series; append them to the earlier `readings`."""

    def judge(new_readings: list[float]) -> None:
        earlier = [celsius for celsius in readings if math.isfinite(celsius)][-window:]
        readings.extend(new_readings)
        expected = windows([*earlier, *new_readings], window)[len(earlier) :]
        actual = [message.celsius for message in harness.send(new_readings, apart=_seconds_apart(harness))]
        are_correct = len(actual) == len(expected) and all(map(_is_mean, actual, expected))
        situation = f"With the window {window} and the earlier readings {earlier}"
        message = (
            f"{situation}, {new_readings} °C became {_rounded(actual)} instead of {_rounded(map(fmean, expected))}."
        )
        expect(are_correct, message, fraction=fraction)

    expect_each(drawn, judge, draw, count=_series_count(harness))


def expect_switching(
    harness: NodeHarness,
    drawn: Temperatures,
    draw: Random,
    prefix: str = "",
    *,
    fraction: float,
    hot: float = HOT,
    cool: float = COOL,
) -> None:
    """Fail the check unless a guard makes the correct decisions on each of these series."""

    def judge(temperatures: list[float]) -> None:
        expect_decisions(
            harness, temperatures, prefix, hot=hot, cool=cool, fraction=fraction, apart=_seconds_apart(harness)
        )

    expect_each(drawn, judge, draw, count=_series_count(harness))


def _series_count(harness: NodeHarness) -> int:
    return 6 if harness.time == LOCKSTEP else 2


def _seconds_apart(harness: NodeHarness) -> float:
    """Return the time in s between two temperatures; a node's queue holds a whole series."""
    return LOCKSTEP_PERIOD if harness.time == LOCKSTEP else MESSAGE_SECONDS


def _is_mean(number: float, readings: Sequence[float]) -> bool:
    return abs(number - fmean(readings)) <= max(TOLERANCE, FLOAT32 * max(map(abs, readings)))


def _rounded(numbers: Iterable[float]) -> list[float]:
    return [round(number, 2) for number in numbers]
