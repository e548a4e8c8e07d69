"""Goals inside and outside the ranges that the contract allows, many of them at the limits."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from autograder.checks.ch03_interfaces.support.contract import MAX_DISTANCE, MAX_SPEED

EDGE = 1e-6  # m or m/s: how near to a limit a value is tested
PLAIN_DISTANCE = -1.0  # m: a distance that no goal may have


def _valid_values(limit: float) -> st.SearchStrategy[float]:
    return st.sampled_from((limit, limit - EDGE, limit / 7, limit / 3))


def _invalid_values(limit: float) -> st.SearchStrategy[float]:
    return st.sampled_from((0.0, math.nan, limit + EDGE, -EDGE, limit * 1.04, -limit / 2, math.inf, -math.inf, 1e9))


# Distances in m, and speeds in m/s; a goal without a speed has the default speed.
INVALID_ALONE = (  # each with one value out of range, the plainest first
    (PLAIN_DISTANCE, 0.2),
    (0.0, 0.2),
    (math.nan, 0.2),
    (MAX_DISTANCE + EDGE, 0.2),
    (1.0, -0.1),
    (1.0, 0.0),
    (1.0, math.nan),
    (1.0, MAX_SPEED + EDGE),
)
INVALID_GOALS = (
    st.tuples(_invalid_values(MAX_DISTANCE), _valid_values(MAX_SPEED))
    | st.tuples(_valid_values(MAX_DISTANCE), _invalid_values(MAX_SPEED))
    | st.tuples(_invalid_values(MAX_DISTANCE), _invalid_values(MAX_SPEED))
)
VALID_GOALS = st.tuples(_valid_values(MAX_DISTANCE), _valid_values(MAX_SPEED) | st.none())
