"""The drawn temperatures of 09 find typical mistakes with every seed, and no correct program fails with them."""

from __future__ import annotations

import math
import random
from collections import deque
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from autograder.checking import LOCKSTEP
from autograder.checks.ch09_assessment.hidden import drawn_temperatures as drawn
from autograder.checks.ch09_assessment.support.contract import averages, decisions
from autograder.suite import CheckFailed

SEEDS = range(4)


def test_oracles() -> None:
    assert averages([1.0, math.nan, 3.0, math.inf, 5.0], 2) == [1.0, 2.0, 4.0]
    either = {False, True}
    assert decisions([55.0, 60.0, 55.0, 50.0, 55.0, math.nan, 55.0, 50.0, 55.0]) == [
        *({False}, {True}, {True}, {False}, {False}, {True}, either, {False}, {False})
    ]


class Program:
    """A node in the place of the student's; `answer` gives its answer to a temperature, or None."""

    time = LOCKSTEP

    def __init__(self, answer: Callable[[float], float | bool | None]) -> None:
        self._answer = answer

    def send(self, temperatures: list[float], *, apart: float) -> list[Any]:
        del apart
        answers_ = [answer for answer in map(self._answer, temperatures) if answer is not None]
        return [SimpleNamespace(celsius=answer, cooling=answer) for answer in answers_]


def _smoother(window: int, counts: Callable[[float, list[float]], bool]) -> Callable[[float], float | None]:
    newest: deque[float] = deque(maxlen=window)

    def answer(celsius: float) -> float | None:
        if not counts(celsius, [*newest]):
            return None
        newest.append(celsius)
        return sum(newest) / len(newest)  # -inf + inf is nan; math.fsum raises

    return answer


@pytest.mark.parametrize(
    ("counts", "edges", "is_right"),
    [
        (lambda celsius, _: math.isfinite(celsius), drawn.UNKNOWN, True),
        (lambda celsius, _: math.isfinite(celsius), (1e20, -1e20), True),
        (lambda celsius, _: not math.isnan(celsius), drawn.UNKNOWN, False),
        (lambda celsius, _: celsius > 0.0, (0.0, -80.0), False),
        (lambda celsius, newest: celsius not in newest[-1:], (), False),
    ],
)
def test_temperatures_tell_smoothers_apart(
    counts: Callable[[float, list[float]], bool], edges: tuple[float, ...], is_right: bool
) -> None:
    for seed in SEEDS:
        program: Any = Program(_smoother(2, counts))
        try:
            drawn.expect_series(program, drawn.series(*edges), 2, random.Random(seed), [], fraction=0.5)
        except CheckFailed:
            assert not is_right
        else:
            assert is_right


@pytest.mark.parametrize(
    ("hot", "cool", "edges", "compare", "is_right"),
    [
        (60.0, 50.0, (60.0, 60.0, 50.0, 50.0), lambda celsius: (celsius >= 60.0, celsius <= 50.0), True),
        (60.0, 50.0, (60.0, 60.0, 50.0, 50.0), lambda celsius: (celsius > 60.0, celsius <= 50.0), False),
        (60.0, 50.0, (60.0, 60.0, 50.0, 50.0), lambda celsius: (celsius >= 60.0, celsius < 50.0), False),
        (60.0, 50.0, (), lambda celsius: (celsius >= 60.0, celsius < 60.0), False),
        (60.0, 50.0, drawn.UNKNOWN, lambda celsius: (celsius >= 60.0, celsius <= 50.0), False),
        (0.0, -20.0, (), lambda celsius: (abs(celsius) >= 0.0, celsius <= -20.0), False),
    ],
)
def test_temperatures_tell_guards_apart(
    hot: float, cool: float, edges: tuple[float, ...], compare: Callable[[float], tuple[bool, bool]], is_right: bool
) -> None:
    def guard() -> Callable[[float], bool]:
        state = {"cooling": False}

        def answer(celsius: float) -> bool:
            is_hot, is_cool = compare(celsius)
            state["cooling"] = is_hot or (state["cooling"] and not is_cool)
            return state["cooling"]

        return answer

    for seed in SEEDS:
        program: Any = Program(guard())
        strategy = drawn.around_thresholds(*edges, hot=hot, cool=cool)
        try:
            drawn.expect_switching(program, strategy, random.Random(seed), fraction=0.5, hot=hot, cool=cool)
        except CheckFailed:
            assert not is_right
        else:
            assert is_right
