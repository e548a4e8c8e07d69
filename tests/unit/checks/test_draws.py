"""Every hidden input is within the bounds of its chapter's contract, whatever the seed."""

from __future__ import annotations

import math
import random

import pytest

from autograder.checks.ch03_interfaces.hidden.trips import draw_bad_legs, draw_reserves, draw_too_far, draw_trips
from autograder.checks.ch03_interfaces.support.contract import MAX_LEGS, METRES_PER_PERCENT

SEEDS = range(1000)
EXACT = 1e-6  # percent: what adding up the legs in another order may change is far less


def test_no_trip_has_more_legs_than_its_message_holds() -> None:
    for seed in SEEDS:
        draw = random.Random(f"{seed}:test_trip_level")
        legs = [*(trip.legs for trip in draw_trips(draw)), *draw_too_far(draw, 20), *dict(draw_bad_legs(draw)).values()]
        legs += [trip for drawn in draw_reserves(draw) for trip in drawn.trips]
        assert max(map(len, legs)) <= MAX_LEGS


def test_some_trip_has_as_many_legs_as_its_message_holds() -> None:
    lengths = {len(trip.legs) for seed in range(50) for trip in draw_trips(random.Random(seed))}
    assert max(lengths) == MAX_LEGS


def test_a_battery_lasts_for_a_trip_and_what_is_left_is_no_matter_of_rounding() -> None:
    for seed in SEEDS:
        for trip in draw_trips(random.Random(f"{seed}:test_trip_level")):
            used = sum(trip.legs) / METRES_PER_PERCENT
            assert all(0.0 <= leg < math.inf for leg in trip.legs)
            assert 0 <= trip.left(trip.level) < trip.level <= 100
            assert min(used % 1.0, -used % 1.0) > EXACT
            assert math.floor(trip.level + trip.over + 0.5) == trip.level


def test_a_short_trip_leaves_a_reserve_to_choose() -> None:
    for seed in SEEDS:
        for drawn in draw_reserves(random.Random(f"{seed}:test_trip_possible")):
            for trip in drawn.trips:
                left = math.floor(drawn.level - sum(trip) / METRES_PER_PERCENT)
                assert 0 <= drawn.reserve < left <= drawn.level <= 100
                assert sum(trip) < drawn.level  # also for whoever takes a metre for a percent


@pytest.mark.parametrize("level", [10, 39])
def test_a_trip_too_far_takes_more_than_there_is(level: int) -> None:
    for seed in SEEDS:
        for legs in draw_too_far(random.Random(seed), level):
            assert sum(legs) / METRES_PER_PERCENT > level + EXACT


def test_each_bad_leg_stands_beside_a_right_one() -> None:
    for seed in SEEDS:
        for bad, legs in draw_bad_legs(random.Random(seed)):
            assert len(legs) == 2
            assert not 0.0 <= bad < math.inf
            assert sum(0.0 <= leg < math.inf for leg in legs) == 1
