"""Step 2, navigation_controller: driving, turning and standing still."""

from __future__ import annotations

import math
import random
from dataclasses import replace

from autograder.checking import LOCKSTEP, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.drawn_drives import (
    AGE_MARGIN,
    CLEAR,
    DRIVE,
    LEFT,
    RIGHT,
    STILL,
    Moment,
    View,
    calls,
    expect_drive,
    expect_enabled,
    stops,
    turns,
)
from autograder.checks.ch08_capstone.hidden.drawn_scans import metres
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, expect_exact_limits
from autograder.checks.ch08_capstone.hidden.fallback import BodyRunner
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_still, expect_turning
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

check = group("step_2")
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN = PARAMETERS[CONTROLLER]["turn_speed"].default
DATA_TIMEOUT = PARAMETERS[CONTROLLER]["data_timeout"].default
AHEAD = 0.1, 0.6, 1.0, 5.0  # s by which the lidar's clock is ahead; some of them are more than data_timeout
TURN_RIGHT, TURN_LEFT = View(0.4, 1.0, 2.0), View(0.4, 2.0, 1.0)
# Drives in which the turn is kept, although one side is blind for a while, or the robot is held still.
KEPT_WHILE_BLIND = Moment(TURN_RIGHT), Moment(replace(TURN_RIGHT, left=math.nan)), Moment(TURN_LEFT)
KEPT_WHILE_HELD = Moment(TURN_RIGHT), Moment(CLEAR, enable=False), Moment(TURN_LEFT, enable=True)
BLIND = scan(Part(-35.0, 35.0, math.nan))


@check(
    points=2,
    covers=("drive", "ten-hertz", "stand-or-go"),
    needs=("build",),
    after=("sectors", "controller"),
    doc=contract.NODES_DOC,
)
@hint("The way is clear: linear.x is forward_speed.")
@hint("The timer calls control ten times a second, and control publishes once each time, whatever happens.")
def test_drives(judge_driving: BodyRunner, draw: random.Random) -> None:
    """It drives forward while the way is clear, with ten commands a second."""
    distance = draw.uniform(0.9, 3.0)

    def expect_drives(driving: System) -> None:
        start = driving.seconds
        messages = driving.publish_scans(scan(fill=distance), 2.0)
        expect_driving(messages.commands, f"With {distance:.2f} m of free space all around", SPEED, always=True)
        rate = driving.harness.rate("/cmd_vel", start)
        expect(9.0 <= rate <= 11.0, f"It published {rate:.1f} commands a second, instead of 10.", fraction=0.5)

    judge_driving(expect_drives)


@check(
    points=3,
    covers=("turn", "more-room", "keeps-turn", "starts-turn", "ends-turn"),
    needs=("build",),
    after=("drives",),
)
@hint("Compare left with right when the turn begins, and remember the choice.")
@hint("The remembered turn ends when the way is clear again, not when the sides look different.")
def test_turns(judge_driving: BodyRunner, draw: random.Random) -> None:
    """In front of an obstacle it turns towards the side with more room, and keeps the direction until it is clear."""
    seed = draw.getrandbits(64)
    judge_driving(lambda driving: _expect_turns(driving, random.Random(seed)))


def _expect_turns(driving: System, draw: random.Random) -> None:
    sides = ((LEFT, 2.0, 1.0), (RIGHT, 1.0, 2.0), (LEFT, math.inf, math.inf), (RIGHT, 1.0, math.inf))
    for side, left, right in sides:
        driving.publish_scans(OPEN)
        commands = driving.publish_scans(View(0.4, left, right).scan()).commands
        situation = f"With something 0.4 m ahead, {metres(left)} of room on the left and {metres(right)} on the right"
        expect_turning(commands, situation, side, TURN, fraction=0.5 if left == right else 0.0)
        expect_driving(driving.publish_scans(OPEN).commands, "When the way is clear again", SPEED, fraction=0.5)
    expect_drive(driving, KEPT_WHILE_BLIND, DRIVE, LEFT, RIGHT, fraction=0.75)
    # In drives in which the robot also stands still, this check judges only what the robot does afterwards.
    expect_each(
        turns(),
        lambda drive: expect_drive(driving, drive, DRIVE, LEFT, RIGHT, fraction=0.5),
        draw,
        count=_case_count(driving, 18),
    )
    expect_exact_limits(driving)


def _case_count(system: System, count: int) -> int:
    """Return how many drawn drives a check can afford: fewer in real time."""
    return count if system.harness.time == LOCKSTEP else 2


@check(points=3, covers=("untrusted", "newest"), needs=("build",), after=("drives",))
@hint("No clearance yet, one that is not valid, one that is too old: publish Twist() as it is.")
@hint("Its age is self.get_clock().now() - Time.from_msg(clearance.header.stamp), however late it came.")
def test_stops(judge_driving: BodyRunner, slow_system: SharedSystem, draw: random.Random) -> None:
    """It stands still before the first scan, with an invalid clearance, and with one that is too old."""
    seed = draw.getrandbits(64)
    judge_driving(lambda driving: _expect_stops(driving, slow_system, random.Random(seed)))


def _expect_stops(driving: System, slow_system: SharedSystem, draw: random.Random) -> None:
    expect_still(driving.before_first_scan.commands, "Before the first scan")
    driving.publish_scans(OPEN)
    expect_still(driving.publish_scans(BLIND).commands, "With nan from every beam ahead", fraction=0.25)
    driving.publish_scans(OPEN)
    start = driving.seconds
    driving.wait(2.0)
    late_commands = driving.messages(start + DATA_TIMEOUT + AGE_MARGIN[driving.harness.time]).commands
    expect_still(late_commands, f"More than {DATA_TIMEOUT} s after the last scan", fraction=0.5)
    expect_each(
        stops(),
        lambda drive: expect_drive(driving, drive, DRIVE, STILL, fraction=0.5),
        draw,
        count=_case_count(driving, 10),
    )
    if driving.harness.time == LOCKSTEP:  # in real time, the clocks of the machine cannot be slowed
        slow_driving = slow_system.get(PROCESSOR, CONTROLLER)
        slow_driving.publish_scans(OPEN)
        slow_driving.wait(DATA_TIMEOUT + AGE_MARGIN[LOCKSTEP])
        slow_commands = slow_driving.wait(1.0).commands
        expect_still(slow_commands, f"More than {DATA_TIMEOUT} s of ROS time after the last scan", fraction=0.75)


@check(points=1, covers="untrusted", needs=("build",), after=("drives", "stops"))
@hint("The lidar's computer has a clock of its own. A stamp that is ahead of yours gives an age below 0.")
@hint("An age below 0 is not more than data_timeout: no abs().")
def test_stamp_ahead(judge_driving: BodyRunner) -> None:
    """It trusts a clearance whose stamp is ahead of its clock: that is not old."""

    def expect_trust(driving: System) -> None:
        expect_drive(driving, tuple(Moment(CLEAR, 3, -seconds) for seconds in AHEAD), DRIVE)
        driving.wait(AHEAD[-1])  # so that no later scan is taken for an earlier one

    judge_driving(expect_trust)


@check(
    points=2,
    covers=("enable", "disabled", "keeps-turn", "ten-hertz"),
    needs=("build",),
    after=("controller", "drives"),
    doc=contract.SERVICE_DOC,
)
@hint("self.create_service(SetBool, 'enable', self.enable_callback)")
@hint("The callback remembers request.data and returns the response with success = True.")
@hint("Held still, the robot does not choose a turn anew, and does not forget the one that it has begun.")
def test_enable(judge_driving: BodyRunner, draw: random.Random) -> None:
    """The service enable holds the robot still, and lets it go again."""
    seed = draw.getrandbits(64)
    judge_driving(lambda driving: _expect_enable_service(driving, random.Random(seed)))


def _expect_enable_service(system: System, draw: random.Random) -> None:
    system.publish_scans(OPEN)
    expect_enabled(system, False)
    commands = system.publish_scans(OPEN, 1.7).commands
    expect_still(commands, "After enable with data: false")
    message = f"Held still, it published a command {message_period.describe_pace(commands)}, instead of ten a second."
    expect(message_period.is_paced(commands, 0.1, system.harness.time), message, fraction=0.75)
    expect_enabled(system, True, fraction=0.5)
    expect_driving(system.publish_scans(OPEN).commands, "After enable with data: true", SPEED, fraction=0.5)
    expect_drive(system, KEPT_WHILE_HELD, STILL, DRIVE, LEFT, RIGHT, fraction=0.75)
    expect_each(
        calls(),
        lambda drive: expect_drive(system, drive, STILL, DRIVE, LEFT, RIGHT, fraction=0.5),
        draw,
        count=_case_count(system, 12),
    )
