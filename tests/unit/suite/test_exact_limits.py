"""Limits that 08 checks to the last digit: a correct program of any style keeps within them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from autograder.checks.ch08_capstone.hidden.exact_limits import (
    EXACT_CLEAR,
    EXACT_HALVES,
    EXACT_LIMIT,
    LIMIT_BELOW_EXACT,
)

MARGIN = 0.1  # m, of steering.py
STYLES: dict[str, Callable[[float], float]] = {
    "remainder": lambda bearing: math.remainder(bearing, math.tau),
    "atan2": lambda bearing: math.atan2(math.sin(bearing), math.cos(bearing)),
    "modulo": lambda bearing: (bearing + math.pi) % math.tau - math.pi,
    "shorter way": lambda bearing: min(bearing % math.tau, math.tau - bearing % math.tau),
    "acos": lambda bearing: math.acos(math.cos(bearing)),
    "float32": lambda bearing: float(np.arctan2(np.sin(np.float32(bearing)), np.cos(np.float32(bearing)))),
}


@pytest.mark.parametrize("style", STYLES)
def test_a_beam_at_the_half_angle_belongs_to_its_sector_in_each_style(style: str) -> None:
    assert any(abs(STYLES[style](side * half)) <= half for half in EXACT_HALVES for side in (-1.0, 1.0))


def test_the_exact_limits_can_be_written_as_32_bit_floats() -> None:
    for number in (*EXACT_HALVES, EXACT_LIMIT, EXACT_CLEAR):
        assert float(np.float32(number)) == number


def test_the_end_of_a_turn_is_the_same_for_each_way_to_compute_it() -> None:
    assert LIMIT_BELOW_EXACT + MARGIN == EXACT_CLEAR
    assert EXACT_CLEAR - LIMIT_BELOW_EXACT >= MARGIN
    assert EXACT_CLEAR - MARGIN >= LIMIT_BELOW_EXACT
