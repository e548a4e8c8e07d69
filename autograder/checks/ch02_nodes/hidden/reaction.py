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
    """It turns left on the spot while something in front is nearer than 1 m."""
    distance = draw.uniform(0.3, 0.8)
    blocked_scan = scan(Part(-5.0, 5.0, distance))
    expect_turn(robot.see(blocked_scan), f"With something {distance:.2f} m ahead")
    single_beam = scan(Part(0.0, 0.0, distance))
    expect_turn(
        robot.see(single_beam), f"With a single beam that reads {distance:.2f} m, straight ahead", fraction=0.75
    )


@check(points=2, covers=("near", "clear"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint("The limit is 1.0 m: anything nearer blocks the way.", "Compare metres with metres, and use < rather than <=.")
def test_threshold(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """Its limit is 1 m: something a little nearer blocks the way, and something a little farther away does not."""
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
    if robot.time == LOCKSTEP:  # in real time, perhaps no command is published in so short a time
        for distance, expect_reaction in (
            (far, reactions.expect_forward),
            (near, reactions.expect_turn),
        ):  # each scan calls for a different reaction from the scan before it
            start = robot.seconds
            robot.show(scan(Part(-3.0, 3.0, distance)), SINGLE_SCAN_SECONDS)
            commands = robot.messages("/cmd_vel", since=start + SETTLED)
            expect_reaction(commands, f"After a single scan with something {distance:.2f} m ahead", fraction=0.75)


@check(points=3, covers=("sector", "minus-inf"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.LASER_SCAN)
@hint("Only beams within 30° of straight ahead count, but min(msg.ranges) uses all beams.")
@hint("A beam's bearing is angle_min + i * angle_increment, wrapped to (-pi, pi].")
def test_only_forward_counts(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It looks 30° to each side, and ignores everything beside and behind it."""
    near = draw.uniform(*NEAR)
    for side, first, last in (("behind", 150.0, 180.0), ("to the left", 45.0, 110.0), ("to the right", -110.0, -45.0)):
        reactions.expect_forward(
            robot.see(scan(Part(first, last, near))), f"With a wall {near:.2f} m {side} and nothing ahead"
        )
    beams, half_width = COARSE if reactions.turns(robot.see(scan(Part(0.0, 0.0, near)))) else FINE
    for sign in (-1.0, 1.0):
        inside, outside = (sign * (contract.HALF_SECTOR + offset) for offset in (-EDGE, EDGE))
        edge_scan = scan(Part(inside - half_width, inside + half_width, near), beams=beams)
        reactions.expect_turn(
            robot.see(edge_scan), f"With something {near:.2f} m away at {inside:.0f}°, in the forward sector"
        )
        edge_scan = scan(Part(outside - half_width, outside + half_width, near), beams=beams)
        reactions.expect_forward(
            robot.see(edge_scan), f"With something {near:.2f} m away at {outside:.0f}°, outside the forward sector"
        )
    parts_around = (Part(first, last, -math.inf) for first, last in ((150.0, 180.0), (45.0, 110.0), (-110.0, -45.0)))
    reactions.expect_forward(
        robot.see(scan(*parts_around)), "With -inf behind and on both sides and nothing ahead", fraction=0.85
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
@hint("math.remainder(bearing, math.tau) wraps any bearing, positive or negative, even by several turns.")
def test_other_lidars(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It takes bearings from the message, for any number of beams and any first bearing."""
    near = draw.uniform(*NEAR)
    beam_count = draw.randrange(500, 800)
    for beams, first, last in ((beam_count, -180.0, None), (1081, -135.0, 135.0), (181, -90.0, 90.0)):
        lidar_text = f"seen by a lidar of {beams} beams that starts at {first:.0f}°"
        scan_ahead = scan(Part(-5.0, 5.0, near), beams=beams, first_bearing=first, last_bearing=last)
        scan_aside = scan(Part(60.0, 85.0, near), beams=beams, first_bearing=first, last_bearing=last)
        reactions.expect_turn(robot.see(scan_ahead), f"With something {near:.2f} m ahead, {lidar_text}")
        situation = f"With something {near:.2f} m to the left, {lidar_text}"
        reactions.expect_forward(robot.see(scan_aside), situation, fraction=0.5)
    readings, fills = st.sampled_from((near, 2.0)), st.just(3.0)
    for lidars, share in ((any_lidars(), 0.7), (SEVERAL_TURNS, 0.3)):
        scan_strategy = drawn_scans(readings, fills, lidars=lidars)
        count = math.ceil(share * case_count(robot))
        expect_each(scan_strategy, lambda case: reactions.expect_for(robot, case, fraction=0.75), draw, count=count)
