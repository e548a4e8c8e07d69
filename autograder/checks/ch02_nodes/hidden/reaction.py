"""Checks of the reaction to obstacles in front of the robot, and only to those."""

from __future__ import annotations

import math
import random

from hypothesis import strategies as st

from autograder.checking import LOCKSTEP, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.drawn_scans import SEVERAL_TURNS, any_lidars, drawn_scans
from autograder.checks.ch02_nodes.support.robot import (
    SETTLED,
    Reactions,
    Robot,
    case_count,
    expect_forward,
    expect_turn,
)
from autograder.checks.ch02_nodes.support.scans import Part, scan

check = group("reaction")
TOPIC_CHECKS = ("subscribes_scan", "publishes_cmd_vel")
REACTION_CHECKS = ("forward_when_clear", "turns_when_blocked")
NEAR = 0.13, 0.18  # m: nearer than any limit that a robot may have, and above range_min
# Degrees to each side of the sector's edge that are not tested; a half sector of 0.5 rad (28.6°) is still detected.
EDGE = 1.0
# A lidar's number of beams, and half the width of an obstacle in degrees. One beam of the coarse lidar hits the
# obstacle. So do three beams of the fine one, for a robot that ignores a single beam.
COARSE, FINE = (360, 0.6), (1800, 0.3)
JUST_BELOW = 0.003  # m below the limit: rounded to centimetres, this distance is the limit
SINGLE_SCAN_SECONDS = 0.4  # s to run after a single scan: more than SETTLED, and the scan is not stale yet


@check(points=2, covers=("clear", "in-range"), needs=TOPIC_CHECKS)
@hint(contract.RULE_FORWARD, "Look at the last branch of control_loop.")
def test_forward_when_clear(robot: Robot, draw: random.Random) -> None:
    """It drives straight on at 0.3 m/s while the nearest thing in front is far away."""
    distance = draw.uniform(1.3, 3.3)
    expect_forward(robot.see(scan(fill=distance)), f"With {distance:.2f} m of free space all around")


@check(points=2, covers=("near", "in-range"), needs=TOPIC_CHECKS)
@hint(contract.RULE_TURN, "Look at the middle branch of control_loop.")
def test_turns_when_blocked(robot: Robot, draw: random.Random) -> None:
    """It turns left on the spot while something stands within 1 m in front."""
    distance = draw.uniform(0.3, 0.8)
    blocked_scan = scan(Part(-5.0, 5.0, distance))
    expect_turn(robot.see(blocked_scan), f"With something {distance:.2f} m ahead")
    single_beam = scan(Part(0.0, 0.0, distance))
    expect_turn(
        robot.see(single_beam), f"With a single beam that reads {distance:.2f} m, straight ahead", fraction=0.75
    )


@check(points=2, covers=("near", "clear"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint("The limit is 1.0 m: nearer blocks, farther does not.", "Compare metres with metres, and with < rather than <=.")
def test_threshold(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """Its limit is 1 m: a little nearer blocks, a little farther does not."""
    margin = draw.uniform(0.02, 0.06)
    limit = contract.SAFETY_DISTANCE
    near, far = limit - margin, limit + margin
    for distance, expect_reaction, fraction in (
        (near, reactions.expect_turn, 0.0),
        (far, reactions.expect_forward, 0.0),
        (limit, reactions.expect_forward, 0.0),  # not nearer than the limit, and exact in a message's float32
        (limit - JUST_BELOW, reactions.expect_turn, 0.75),
    ):
        commands = robot.see(scan(Part(-3.0, 3.0, distance)))
        expect_reaction(commands, f"With something {distance:.3f} m ahead", fraction=fraction)
    if robot.time == LOCKSTEP:  # in real time, perhaps no command comes in so short a time
        for distance, expect_reaction in (
            (far, reactions.expect_forward),
            (near, reactions.expect_turn),
        ):  # each scan calls for a different reaction than the scan before it
            start = robot.seconds
            robot.show(scan(Part(-3.0, 3.0, distance)), SINGLE_SCAN_SECONDS)
            commands = robot.messages("/cmd_vel", since=start + SETTLED)
            expect_reaction(commands, f"After a single scan with something {distance:.2f} m ahead", fraction=0.75)


@check(points=3, covers=("sector", "minus-inf"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.LASER_SCAN)
@hint("Only beams within 30° of forward count; min(msg.ranges) is over all of them.")
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi].")
def test_only_forward_counts(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It looks 30° to each side, and ignores what stands beside and behind it."""
    near = draw.uniform(*NEAR)
    for name, first, last in (("behind", 150.0, 180.0), ("to the left", 45.0, 110.0), ("to the right", -110.0, -45.0)):
        reactions.expect_forward(
            robot.see(scan(Part(first, last, near))), f"With a wall {near:.2f} m {name} and nothing ahead"
        )
    beams, half_width = COARSE if reactions.turns(robot.see(scan(Part(0.0, 0.0, near)))) else FINE
    for side in (-1.0, 1.0):
        inside, outside = (side * (contract.HALF_SECTOR + offset) for offset in (-EDGE, EDGE))
        edge = scan(Part(inside - half_width, inside + half_width, near), beams=beams)
        reactions.expect_turn(
            robot.see(edge), f"With something {near:.2f} m away at {inside:.0f}°, in the forward sector"
        )
        edge = scan(Part(outside - half_width, outside + half_width, near), beams=beams)
        reactions.expect_forward(robot.see(edge), f"With something {near:.2f} m away at {outside:.0f}°, outside of it")
    around = (Part(first, last, -math.inf) for first, last in ((150.0, 180.0), (45.0, 110.0), (-110.0, -45.0)))
    reactions.expect_forward(
        robot.see(scan(*around)), "With -inf behind and at both sides and nothing ahead", fraction=0.85
    )


@check(
    points=2,
    covers=("bearings", "sector"),
    needs=TOPIC_CHECKS,
    after=(*REACTION_CHECKS, "only_forward_counts"),
    doc=contract.LASER_SCAN,
)
@hint("Beam 0 does not always look forward: on many lidars it looks backward.")
@hint("Use angle_min and angle_increment of the message, never a fixed index or a fixed number of beams.")
@hint("math.remainder(bearing, math.tau) wraps any bearing, from above and from below, by as many turns as it takes.")
def test_other_lidars(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It reads bearings from the message: any number of beams, any first bearing."""
    near = draw.uniform(*NEAR)
    beam_count = draw.randrange(500, 800)
    for beams, first, last in ((beam_count, -180.0, None), (1081, -135.0, 135.0), (181, -90.0, 90.0)):
        name = f"from a lidar of {beams} beams that starts at {first:.0f}°"
        ahead = scan(Part(-5.0, 5.0, near), beams=beams, first_bearing=first, last_bearing=last)
        aside = scan(Part(60.0, 85.0, near), beams=beams, first_bearing=first, last_bearing=last)
        reactions.expect_turn(robot.see(ahead), f"With something {near:.2f} m ahead, {name}")
        reactions.expect_forward(robot.see(aside), f"With something {near:.2f} m to the left, {name}", fraction=0.5)
    readings, rest = st.sampled_from((near, 2.0)), st.just(3.0)
    for lidars, share in ((any_lidars(), 0.7), (SEVERAL_TURNS, 0.3)):
        scan_strategy = drawn_scans(readings, rest, lidars=lidars)
        count = math.ceil(share * case_count(robot))
        expect_each(scan_strategy, lambda case: reactions.expect_for(robot, case, fraction=0.75), draw, count=count)
