"""Checks of the published readings, with random scans for each grading."""

import math
import random

from autograder.checking import expect, group, hint
from autograder.checks.chNEW_CHAPTER.support.contract import RANGE_MAX, RANGE_MIN
from autograder.checks.chNEW_CHAPTER.support.robot import Robot, expect_nearest

check = group("readings")  # the points of this group count for the cell grade('NEW_CHAPTER', 'readings')
NO_DISTANCE = (math.nan, math.inf, 0.0, 0.05, 3.9)  # a failure, no obstacle, and three values out of range


@check(points=2, covers="nearest")
@hint("on_scan gets each scan. Publish a Float32, whose field data is the number.")
def test_nearest(robot: Robot, draw: random.Random) -> None:
    """It publishes the smallest reading of each scan."""
    readings = [draw.uniform(1.0, 3.0) for _ in range(36)]
    readings[draw.randrange(1, 36)] = nearest = draw.uniform(0.2, 0.9)
    expect_nearest(robot, readings, nearest)


@check(points=2, covers="counts", after=("nearest",))
@hint("A comparison with nan is always false.")
@hint("A reading counts if range_min <= reading <= range_max.")
def test_counts(robot: Robot, draw: random.Random) -> None:
    """It ignores readings that are not distances within the lidar's range."""
    nearest = draw.uniform(0.2, 0.9)
    readings = [*NO_DISTANCE, nearest]
    draw.shuffle(readings)
    expect_nearest(robot, readings, nearest)
    for limit in (RANGE_MIN, RANGE_MAX):
        expect_nearest(robot, [math.nan, limit], limit)


@check(points=1, covers="silent", after=("nearest",))
@hint("min() of an empty list is an error, unless it has a default.")
def test_silent(robot: Robot, draw: random.Random) -> None:
    """It publishes nothing if no reading counts."""
    expect(bool(robot.answers([1.0])), "A reading of 1 m counts, but the node published nothing.")
    answers = robot.answers(draw.sample(NO_DISTANCE, len(NO_DISTANCE)))
    expect(not answers, f"No reading counted, but the node published {answers}.")
