"""Checks of readings that are not distances, as defined by REP 117."""

from __future__ import annotations

import math
import random
from functools import partial

from hypothesis import strategies as st

from autograder.checking import group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checks.ch02_nodes.hidden.reaction import NEAR, REACTION_CHECKS, TOPIC_CHECKS
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.drawn_scans import drawn_scans, scans_ahead
from autograder.checks.ch02_nodes.support.robot import Reactions, Robot, case_count, expect_stop
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN, Part, scan

check = group("readings")
BESIDE = 4.0, 20.0  # degrees, a little to the left: the beam straight ahead still has a reading
BLIND_HALF_WIDTH = 35.0  # degrees to each side, beyond the forward sector
FAR = st.sampled_from((2.0, 3.0))  # m: readings of a clear path
# Numbers of beams, bearings of beam 0, and steps in degrees.
USUAL_LIDAR = st.sampled_from(((360, 0.0, 1.0), (360, -180.0, 1.0), (181, -90.0, 1.0)))
# For each of two other lidars, in metres: range_min and range_max, the reading of most beams, and two readings for the
# other beams. The first of these two is at a limit and counts. The second is a phantom just beyond this limit.
OTHER_LIMITS = (((0.15625, RANGE_MAX), 3.0, (0.15625, 0.140625)), ((RANGE_MIN, 0.1875), math.inf, (0.1875, 0.21875)))


@check(points=2, covers=("nan", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.REP_117)
@hint("min([nan, 0.5]) is nan, and nan < 1.0 is False.", "Leave nan out before you take the minimum: use math.isnan.")
def test_nan(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """A nan among the readings neither hides an obstacle nor counts as one."""
    near, bearing = draw.uniform(*NEAR), draw.uniform(*BESIDE)
    nan_part = Part(bearing, bearing + 4.0, math.nan)
    reactions.expect_turn(
        robot.see(scan(Part(-10.0, 10.0, near), nan_part)), f"With something {near:.2f} m ahead and a few nan beams"
    )
    reactions.expect_forward(robot.see(scan(nan_part)), "With nothing ahead and a few nan beams")
    nan_scans = scans_ahead(st.sampled_from((math.nan, near)), FAR)
    expect_each(
        nan_scans, lambda case: reactions.expect_for(robot, case, fraction=0.25), draw, count=case_count(robot) // 2
    )
    nan_filled_scans = scans_ahead(st.sampled_from((near, 2.0)), st.just(math.nan))
    expect_each(
        nan_filled_scans,
        lambda case: reactions.expect_for(robot, case, fraction=0.75),
        draw,
        count=case_count(robot) // 2,
    )


@check(points=1, covers=("plus-inf", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.REP_117)
@hint("+inf means that nothing is within range_max.")
def test_plus_inf(robot: Robot, reactions: Reactions) -> None:
    """+inf means that nothing is there, and the way is clear."""
    reactions.expect_forward(robot.see(scan(fill=math.inf)), "With +inf from every beam")


@check(points=2, covers=("minus-inf", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.REP_117)
@hint("-inf means that something is nearer than range_min.", "Do not discard -inf together with invalid readings.")
def test_minus_inf(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """-inf means that something is too near to measure, and the way is blocked."""
    reactions.expect_turn(robot.see(scan(Part(-3.0, 3.0, -math.inf))), "With -inf straight ahead")
    near_and_far_scans = scans_ahead(st.just(-math.inf) | FAR, FAR)
    expect_each(
        near_and_far_scans,
        lambda case: reactions.expect_for(robot, case, fraction=0.75),
        draw,
        count=case_count(robot) // 4,
    )


@check(points=2, covers=("phantom", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.LASER_SCAN)
@hint("Many lidars send 0.0 where they measured nothing.")
@hint("A finite reading counts only from range_min to range_max of the message.")
def test_phantoms(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It ignores phantoms: finite readings below range_min or above range_max."""
    bearing, tiny_reading = draw.uniform(*BESIDE), draw.uniform(0.01, 0.1)
    for reading in (0.0, tiny_reading, RANGE_MAX + 1.0):
        message = scan(Part(bearing, bearing + 5.0, reading))
        reactions.expect_forward(robot.see(message), f"With a few readings of {reading:.2f} and nothing ahead")
    phantom_scans = scans_ahead(
        st.sampled_from((0.0, -1.0, tiny_reading, RANGE_MAX + 0.01, draw.uniform(*NEAR))), FAR | st.just(RANGE_MAX)
    )
    expect_each(phantom_scans, lambda case: reactions.expect_for(robot, case), draw, count=case_count(robot) // 2)
    for limits, fill, readings in OTHER_LIMITS:
        limit_scans = scans_ahead(st.sampled_from(readings), st.just(fill), limits=limits)
        expect_reaction = partial(reactions.expect_for, robot, fraction=0.75 if math.isinf(fill) else 0.0)
        expect_each(limit_scans, expect_reaction, draw, count=case_count(robot) // 4)
    far_scan = scan(fill=5.0, limits=(RANGE_MIN, 10.0))
    reactions.expect_forward(
        robot.see(far_scan), f"With 5 m of free space all around, seen by a lidar of {RANGE_MIN:g} to 10 m"
    )


@check(points=2, covers=("blind", "phantom", "stale"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint(contract.RULE_STOP, 'What is your minimum when no reading is left? It must not mean "clear".')
def test_blind(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It stands still when no reading in the forward sector counts."""
    expect_stop(robot.see(scan(fill=math.nan)), "With nan from every beam")
    empty_scan = scan()
    empty_scan.ranges = []
    expect_stop(robot.see(empty_scan), "With a scan that has no readings at all")
    invalid_readings = st.sampled_from((math.nan, 0.0, -1.0, RANGE_MAX + 1.0))
    expect_each(
        drawn_scans(invalid_readings, invalid_readings, lidars=USUAL_LIDAR),
        lambda case: reactions.expect_for(robot, case, fraction=0.5),
        draw,
        count=case_count(robot) // 4,
    )
    for message, situation in (
        (empty_scan, "With scans that have no readings"),
        (scan(Part(-BLIND_HALF_WIDTH, BLIND_HALF_WIDTH, 0.0)), "With readings of 0.0 everywhere in front"),
    ):
        clear_commands = robot.see(scan())  # the robot must not rely on this scan afterwards
        expect_stop(robot.see(message), f"{situation}, after scans of a clear way", fraction=0.75)
        reactions.expect_forward(clear_commands, "With a clear way")
