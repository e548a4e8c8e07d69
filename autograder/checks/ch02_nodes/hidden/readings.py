"""Readings that are no distances, by REP 117."""

from __future__ import annotations

import math
import random

from autograder.checks import group, hint
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.robot import Robot, expect_forward, expect_stop, expect_turn
from autograder.checks.ch02_nodes.support.scans import RANGE_MAX, RANGE_MIN, Part, scan

check = group("readings")
# range_min, range_max, a reading that counts, one that does not; in metres, and exact in a message's float32.
OTHER_LIMITS = ((0.5, RANGE_MAX, 0.5, 0.25), (RANGE_MIN, 0.75, 0.75, 0.875))
REACTS = ("forward_when_clear", "turns_when_blocked")


@check(points=2, holds=("nan", "readings"), needs=REACTS, doc=contract.REP_117)
@hint("min([nan, 0.5]) is nan, and nan < 1.0 is False.", "Leave nan out before you take the minimum: math.isnan.")
def test_nan(robot: Robot, draw: random.Random) -> None:
    """A nan among the readings hides no obstacle and is none itself."""
    near, bearing = draw.uniform(0.4, 0.8), draw.uniform(-25.0, 20.0)
    hole = Part(bearing, bearing + 4.0, math.nan)
    expect_turn(
        robot.see(scan(Part(-10.0, 10.0, near), hole)), f"With something {near:.2f} m ahead and a few nan beams"
    )
    first = Part(0.0, 0.0, math.nan)
    expect_turn(robot.see(scan(Part(-10.0, 10.0, near), first)), f"With something {near:.2f} m ahead and beam 0 nan")
    expect_forward(robot.see(scan(hole)), "With nothing ahead and a few nan beams")
    for distance, expect_reaction in ((near, expect_turn), (2.0, expect_forward)):
        lone = scan(Part(-35.0, 35.0, math.nan), Part(bearing, bearing + 1.5, distance))
        said = f"With nan ahead but for one or two beams, which read {distance:.2f} m"
        expect_reaction(robot.see(lone), said, fraction=0.75)


@check(points=1, holds=("plus-inf", "readings"), needs=REACTS, doc=contract.REP_117)
@hint("+inf says: nothing within range_max.")
def test_plus_inf(robot: Robot) -> None:
    """+inf means that nothing is there, and the way is clear."""
    expect_forward(robot.see(scan(fill=math.inf)), "With +inf from every beam")


@check(points=2, holds=("minus-inf", "readings"), needs=REACTS, doc=contract.REP_117)
@hint("-inf says: something is nearer than range_min.", "Do not throw -inf away together with other odd numbers.")
def test_minus_inf(robot: Robot, draw: random.Random) -> None:
    """-inf means that something is too near to measure, and the way is blocked."""
    bearing = draw.uniform(-20.0, 15.0)
    expect_turn(robot.see(scan(Part(bearing, bearing + 5.0, -math.inf))), f"With -inf at {bearing:.0f}°")


@check(points=2, holds=("phantom", "readings"), needs=REACTS, doc=contract.LASER_SCAN)
@hint("Many lidars send 0.0 where they measured nothing.")
@hint("A finite reading counts only from range_min to range_max of the message.")
def test_phantoms(robot: Robot, draw: random.Random) -> None:
    """Finite readings below range_min or above range_max are phantoms."""
    bearing, tiny = draw.uniform(-20.0, 15.0), draw.uniform(0.01, 0.1)
    expect_forward(robot.see(scan(Part(bearing, bearing + 5.0, 0.0))), "With a few readings of 0.0 and nothing ahead")
    expect_forward(
        robot.see(scan(Part(bearing, bearing + 5.0, tiny))), f"With readings of {tiny:.2f} m, below range_min, ahead"
    )
    expect_forward(
        robot.see(scan(Part(bearing, bearing + 5.0, RANGE_MAX + 1.0))), "With a few readings above range_max"
    )
    for low, high, counts, phantom in OTHER_LIMITS:
        lidar = f"from a lidar of {low:g} to {high:g} m"
        for reading, expect_reaction in ((counts, expect_turn), (phantom, expect_forward)):
            shown = scan(Part(bearing, bearing + 5.0, reading), fill=math.inf, limits=(low, high))
            expect_reaction(robot.see(shown), f"With readings of {reading:g} m ahead, {lidar}")
    far = scan(fill=5.0, limits=(RANGE_MIN, 10.0))
    expect_forward(robot.see(far), f"With 5 m of free space all around, from a lidar of {RANGE_MIN:g} to 10 m")


@check(points=2, holds=("blind", "phantom", "stale"), needs=REACTS)
@hint(contract.RULE_STOP, 'What does your minimum give when no reading is left? It must not mean "clear".')
def test_blind(robot: Robot) -> None:
    """It stands still when no beam in front has a usable reading."""
    expect_stop(robot.see(scan(fill=math.nan)), "With nan from every beam")
    expect_stop(robot.see(scan(Part(-35.0, 35.0, math.nan))), "With nan from every beam in front")
    beyond = scan(Part(-35.0, 35.0, RANGE_MAX + 1.0))
    expect_stop(robot.see(beyond), "With nothing but readings above range_max in front")
    none = scan()
    none.ranges = []
    expect_stop(robot.see(none), "With a scan that has no readings at all")
    for shown, situation in (
        (none, "With scans that have no readings"),
        (scan(Part(-35.0, 35.0, 0.0)), "With nothing but 0.0 in front"),
        (scan(Part(-35.0, 35.0, -1.0)), "With nothing but -1.0 in front"),
    ):
        robot.see(scan(), 0.5)  # it must not count on
        expect_stop(robot.see(shown), f"{situation}, after clear ones", fraction=0.75)
