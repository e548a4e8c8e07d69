"""Inputs that 05 to 09 draw from a seed are within the bounds of their contracts, whatever the seed."""

from __future__ import annotations

import random

import numpy as np
import pytest

from autograder.checks.ch05_parameters.hidden import changes, declaration, start_values
from autograder.checks.ch05_parameters.support import contract as parameters
from autograder.checks.ch07_best_practices.support import sensor_run
from autograder.checks.ch07_best_practices.support.robot import expected_statuses
from autograder.checks.ch08_capstone.hidden import drives
from autograder.checks.ch08_capstone.hidden import launches as navigation
from autograder.checks.ch08_capstone.support import contract as capstone
from autograder.checks.ch09_assessment.hidden import launches as guarded
from autograder.checks.ch09_assessment.hidden import nodes
from autograder.checks.ch09_assessment.support import contract as assessment
from sim import RobotSpec, Simulation, clearance, start

SEEDS = range(1000)
SOME = range(0, 1000, 25)  # for slow tests


def _allowed(name: str, value: float) -> bool:
    specification = parameters.SPECIFICATIONS[name]
    return (
        specification.low is not None
        and specification.high is not None
        and specification.low <= value <= specification.high
    )


def test_05_starts_with_values_that_are_allowed_and_fit_each_other() -> None:
    for seed in SEEDS:
        drawn = start_values.start_numbers(seed)
        assert all(_allowed(name, value) for name, value in drawn.items())
        assert drawn["safety_distance"] < drawn["slow_distance"]
        assert isinstance(drawn["battery_threshold"], int)
        assert 5 <= drawn["battery_threshold"] <= 95  # values beside it are charges, too


def test_05_asks_for_changes_that_only_the_distances_forbid() -> None:
    for seed in SEEDS:
        above, below = changes.draw_contradictions(random.Random(seed))
        assert _allowed("safety_distance", above)
        assert _allowed("slow_distance", below)
        assert above > 1.0
        assert below < 0.5
        safety, slow, far, near = changes.draw_distances(random.Random(seed))
        assert _allowed("safety_distance", far)
        assert _allowed("slow_distance", near)
        assert near < safety < slow < far
        assert safety < 1.0  # the default slow distance, with which it has to fit, too
        assert slow > 0.5


def test_05_asks_for_values_outside_of_each_range() -> None:
    limited = [specification for specification in parameters.SPECIFICATIONS.values() if specification.low is not None]
    for seed in SEEDS:
        for specification in limited:
            low, high = declaration._values_outside(specification, random.Random(seed))
            assert type(low) is type(high) is type(specification.default)
            assert isinstance(low, int | float)
            assert isinstance(high, int | float)
            assert specification.low is not None
            assert specification.high is not None
            assert low < specification.low
            assert high > specification.high


def test_07_finds_seeds_that_a_parameter_may_have() -> None:
    for seed in SOME:
        flaky_seed, probability, max_errors = sensor_run.draw_flaky(random.Random(seed))
        assert 1 <= flaky_seed <= 2**31 - 1
        statuses = expected_statuses(flaky_seed, probability, sensor_run.REAL_FLAKY_READINGS, max_errors)
        assert statuses.count(f"unstable: {max_errors + 1} in a row") >= 2


def test_08_launches_with_values_within_the_ranges() -> None:
    for seed in SEEDS:
        for node, values in navigation.draw_values(seed).items():
            for name, value in values.items():
                bounds = capstone.PARAMETERS[node][name]
                assert bounds.lowest <= value <= bounds.highest


@pytest.mark.parametrize("seed", SOME)
def test_08_draws_corridors_in_which_the_robot_is_free_and_can_drive(seed: int) -> None:
    bend = drives.draw_bend(random.Random(seed))
    simulation = Simulation(bend.world, (RobotSpec(radius=drives.RADIUS),), seed=1)
    assert clearance(simulation, start(simulation)).distance > 0.1
    at_start = bend.world.starts[0]
    assert float(bend.share(np.array([at_start.x]), np.array([at_start.y]))[0]) < 0.2
    assert float(bend.share(np.array([bend.first]), np.array([bend.side * bend.second]))[0]) == 1.0


def test_09_draws_a_cool_threshold_below_the_other_one() -> None:
    for seed in SEEDS:
        hot, cool = nodes.draw_thresholds(random.Random(seed))
        assert cool + 2.0 < hot - 2.0  # with room for temperatures between them
        assert assessment.COOL < guarded.draw_hot(seed) < assessment.HOT
        period, mean, swing = nodes.draw_wave(random.Random(seed))
        assert period > 0.0
        assert (period, mean, swing) != (assessment.PERIOD, assessment.MEAN, assessment.SWING)
