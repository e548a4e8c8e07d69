"""Goals inside and outside of the ranges that the contract allows, many of them at the limits."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from autograder.checks.ch03_interfaces.support.contract import MAX_DISTANCE, MAX_SPEED

PLAIN_DISTANCE = -1.0  # m, which no goal may have


def _valid(limit: float) -> st.SearchStrategy[float]:
    return st.sampled_from((limit, limit - 1e-6, limit / 7, limit / 3))


def _invalid(limit: float) -> st.SearchStrategy[float]:
    return st.sampled_from((0.0, math.nan, limit + 1e-6, -1e-6, limit * 1.04, -limit / 2, math.inf, -math.inf, 1e9))


# Distances in m, and speeds in m/s; without a speed, the default is driven.
INVALID_GOALS = (
    st.tuples(_invalid(MAX_DISTANCE), _valid(MAX_SPEED))
    | st.tuples(_valid(MAX_DISTANCE), _invalid(MAX_SPEED))
    | st.tuples(_invalid(MAX_DISTANCE), _invalid(MAX_SPEED))
)
VALID_GOALS = st.tuples(_valid(MAX_DISTANCE), _valid(MAX_SPEED) | st.none())
