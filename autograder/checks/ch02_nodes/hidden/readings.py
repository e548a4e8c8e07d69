"""Checks of readings that are not distances, as defined by REP 117."""

from __future__ import annotations

import math
import random

from autograder.checking import group, hint
from autograder.checks.ch02_nodes.hidden.reaction import NEAR, REACTION_CHECKS, TOPIC_CHECKS
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.robot import Reactions, Robot, expect_stop
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN, Part, scan

check = group("readings")
# range_min, range_max, the reading of all other beams, a reading that counts, and one that does not, in metres. All are
# exact in a message's float32. A robot that does not handle +inf loses only a part of the points.
OTHER_LIMITS = ((0.15625, RANGE_MAX, 3.0, 0.15625, 0.140625), (RANGE_MIN, 0.1875, math.inf, 0.1875, 0.21875))
BESIDE = 4.0, 20.0  # degrees, a little to the left: the beam straight ahead still has a reading
BLIND_HALF_WIDTH = 35.0  # degrees to each side, beyond the forward sector


@check(points=2, covers=("nan", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.REP_117)
@hint("min([nan, 0.5]) is nan, and nan < 1.0 is False.", "Leave nan out before you take the minimum: math.isnan.")
def test_nan(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """A nan among the readings hides no obstacle and is none itself."""
    near, bearing = draw.uniform(*NEAR), draw.uniform(*BESIDE)
    hole = Part(bearing, bearing + 4.0, math.nan)
    reactions.expect_turn(
        robot.see(scan(Part(-10.0, 10.0, near), hole)), f"With something {near:.2f} m ahead and a few nan beams"
    )
    first = Part(0.0, 0.0, math.nan)
    reactions.expect_turn(
        robot.see(scan(Part(-10.0, 10.0, near), first)), f"With something {near:.2f} m ahead and beam 0 nan"
    )
    reactions.expect_forward(robot.see(scan(hole)), "With nothing ahead and a few nan beams")
    for distance, expect_reaction in ((near, reactions.expect_turn), (2.0, reactions.expect_forward)):
        narrow = scan(Part(-BLIND_HALF_WIDTH, BLIND_HALF_WIDTH, math.nan), Part(-2.0, 2.0, distance))
        situation = f"With nan ahead but for five beams straight ahead, which read {distance:.2f} m"
        expect_reaction(robot.see(narrow), situation, fraction=0.75)


@check(points=1, covers=("plus-inf", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.REP_117)
@hint("+inf says: nothing within range_max.")
def test_plus_inf(robot: Robot, reactions: Reactions) -> None:
    """+inf means that nothing is there, and the way is clear."""
    reactions.expect_forward(robot.see(scan(fill=math.inf)), "With +inf from every beam")


@check(points=2, covers=("minus-inf", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.REP_117)
@hint("-inf says: something is nearer than range_min.", "Do not throw -inf away together with other odd numbers.")
def test_minus_inf(robot: Robot, reactions: Reactions) -> None:
    """-inf means that something is too near to measure, and the way is blocked."""
    reactions.expect_turn(robot.see(scan(Part(-3.0, 3.0, -math.inf))), "With -inf straight ahead")


@check(points=2, covers=("phantom", "readings"), needs=TOPIC_CHECKS, after=REACTION_CHECKS, doc=contract.LASER_SCAN)
@hint("Many lidars send 0.0 where they measured nothing.")
@hint("A finite reading counts only from range_min to range_max of the message.")
def test_phantoms(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """Finite readings below range_min or above range_max are phantoms."""
    bearing, tiny = draw.uniform(*BESIDE), draw.uniform(0.01, 0.1)
    reactions.expect_forward(
        robot.see(scan(Part(bearing, bearing + 5.0, 0.0))), "With a few readings of 0.0 and nothing ahead"
    )
    reactions.expect_forward(
        robot.see(scan(Part(bearing, bearing + 5.0, tiny))), f"With readings of {tiny:.2f} m, below range_min, ahead"
    )
    reactions.expect_forward(
        robot.see(scan(Part(bearing, bearing + 5.0, RANGE_MAX + 1.0))), "With a few readings above range_max"
    )
    for low, high, fill, counts, phantom in OTHER_LIMITS:
        lidar = f"from a lidar of {low:g} to {high:g} m"
        for reading, first, expect_reaction in (
            (counts, -3.0, reactions.expect_turn),
            (phantom, bearing, reactions.expect_forward),
        ):
            message = scan(Part(first, first + 6.0, reading), fill=fill, limits=(low, high))
            situation, fraction = f"With readings of {reading:g} m ahead, {lidar}", 0.75 if math.isinf(fill) else 0.0
            expect_reaction(robot.see(message), situation, fraction=fraction)
    far = scan(fill=5.0, limits=(RANGE_MIN, 10.0))
    reactions.expect_forward(
        robot.see(far), f"With 5 m of free space all around, from a lidar of {RANGE_MIN:g} to 10 m"
    )


@check(points=2, covers=("blind", "phantom", "stale"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint(contract.RULE_STOP, 'What does your minimum give when no reading is left? It must not mean "clear".')
def test_blind(robot: Robot, reactions: Reactions) -> None:
    """It stands still when no beam in front has a usable reading."""
    expect_stop(robot.see(scan(fill=math.nan)), "With nan from every beam")
    empty = scan()
    empty.ranges = []
    expect_stop(robot.see(empty), "With a scan that has no readings at all")
    for message, situation in (
        (scan(Part(-BLIND_HALF_WIDTH, BLIND_HALF_WIDTH, math.nan)), "With nan from every beam in front"),
        (
            scan(Part(-BLIND_HALF_WIDTH, BLIND_HALF_WIDTH, RANGE_MAX + 1.0)),
            "With nothing but readings above range_max in front",
        ),
    ):
        expect_stop(robot.see(message), situation, fraction=0.5)
    for message, situation in (
        (empty, "With scans that have no readings"),
        (scan(Part(-BLIND_HALF_WIDTH, BLIND_HALF_WIDTH, 0.0)), "With nothing but 0.0 in front"),
        (scan(Part(-BLIND_HALF_WIDTH, BLIND_HALF_WIDTH, -1.0)), "With nothing but -1.0 in front"),
    ):
        clear = robot.see(scan())  # it must not rely on this scan afterwards
        expect_stop(robot.see(message), f"{situation}, after clear ones", fraction=0.75)
        reactions.expect_forward(clear, "With a clear way, which is no reason to stand still,")
