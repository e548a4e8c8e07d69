"""The trips and batteries that 03 draws are legal, and the answers of correct programs of any style are accepted."""

from __future__ import annotations

import math
from decimal import ROUND_HALF_UP, Decimal

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.checks.ch03_interfaces.hidden import trips
from autograder.checks.ch03_interfaces.support.contract import MAX_LEGS, METRES_PER_PERCENT, UNKNOWN

LEVELS = st.integers(0, 100)
FEW = settings(max_examples=200, deadline=None)


@FEW
@given(level=LEVELS, data=st.data())
def test_a_trip_fits_into_its_message(level: int, data: st.DataObject) -> None:
    trip = data.draw(trips.any_trips(level))
    assert len(trip.legs) <= MAX_LEGS
    assert -(2**31) <= trip.reserve < 2**31


@FEW
@given(level=LEVELS, data=st.data())
def test_two_ways_to_add_up_the_legs_are_accepted(level: int, data: st.DataObject) -> None:
    trip = data.draw(trips.any_trips(level))
    accepted = trips.answers(level, trip.legs, trip.reserve)
    if (False, UNKNOWN) not in accepted:
        for used in (sum(trip.legs) / METRES_PER_PERCENT, sum(leg / METRES_PER_PERCENT for leg in trip.legs)):
            at_end = math.floor(max(0.0, level - used))
            assert (used <= level and at_end >= trip.reserve, at_end) in accepted


@FEW
@given(level=st.integers(1, 100), data=st.data())
def test_long_legs_take_more_than_the_battery_has(level: int, data: st.DataObject) -> None:
    assert trips.answers(level, data.draw(trips.long_legs(level)), 0) == {(False, 0)}


@FEW
@given(legs=trips.wrong_legs())
def test_wrong_legs_have_no_level_at_the_end(legs: tuple[float, ...]) -> None:
    assert len(legs) <= MAX_LEGS
    assert trips.answers(100, legs, 0) == {(False, UNKNOWN)}


@FEW
@given(percentage=trips.PERCENTAGES)
def test_each_way_to_round_halves_up_is_accepted(percentage: float) -> None:
    percent = float(np.float32(percentage)) * 100.0
    accepted = trips.whole_percents(percentage)
    assert math.floor(percent + 0.5) in accepted
    assert int(Decimal(percent).to_integral_value(rounding=ROUND_HALF_UP)) in accepted


@FEW
@given(percentage=trips.INVALID_PERCENTAGES)
def test_a_percentage_that_is_none_stays_none_as_a_32_bit_float(percentage: float) -> None:
    assert not 0.0 <= float(np.float32(percentage)) <= 1.0
    assert trips.whole_percents(percentage) == {UNKNOWN}
