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
from autograder.checks.ch08_capstone.hidden.drawn_scans import distance_text
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, expect_exact_limits
from autograder.checks.ch08_capstone.hidden.fallback import BodyRunner
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR, TOLERANCE
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_still, expect_turning
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

check = group("step_2")
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN_SPEED = PARAMETERS[CONTROLLER]["turn_speed"].default
DATA_TIMEOUT = PARAMETERS[CONTROLLER]["data_timeout"].default
CLOCK_LEADS = 0.1, 0.6, 1.0, 5.0  # s by which the lidar's clock is ahead; some exceed data_timeout
TURN_RIGHT, TURN_LEFT = View(0.4, 1.0, 2.0), View(0.4, 2.0, 1.0)
LONG_AGO, LATE_SCANS = 5.0, 8  # s, and scans of this age until the clearance before them is too old as well
# Drives in which the robot stands still for a while. Meanwhile, no turn ends and none begins.
KEPT_WHILE_UNTRUSTED = (
    (Moment(TURN_RIGHT), Moment(replace(TURN_RIGHT, left=math.nan)), Moment(TURN_LEFT)),
    (Moment(TURN_RIGHT), Moment(replace(CLEAR, left=math.nan)), Moment(TURN_LEFT)),
    (Moment(replace(TURN_RIGHT, left=math.nan)), Moment(TURN_LEFT)),
    (Moment(TURN_RIGHT), Moment(CLEAR, LATE_SCANS, LONG_AGO), Moment(TURN_LEFT)),
    (Moment(TURN_RIGHT, LATE_SCANS, LONG_AGO), Moment(TURN_LEFT)),
)
KEPT_WHILE_HELD = (
    (Moment(TURN_RIGHT), Moment(CLEAR, enable=False), Moment(TURN_LEFT, enable=True)),
    (Moment(TURN_RIGHT, enable=False), Moment(TURN_LEFT), Moment(TURN_LEFT, enable=True)),
)
BLIND = scan(Part(-35.0, 35.0, math.nan))
# The side to which the robot turns, and the distances on the left and on the right in m.
SIDES = (
    (LEFT, 2.0, 1.0),
    (RIGHT, 1.0, 2.0),
    (LEFT, math.inf, math.inf),
    (LEFT, math.inf, 1.0),
    (RIGHT, 1.0, math.inf),
    (LEFT, 1.0, -math.inf),
    (RIGHT, -math.inf, 1.0),
)


@check(
    points=2,
    covers=("drive", "ten-hertz", "stand-or-go", "straight"),
    needs=("build",),
    after=("sectors", "controller"),
    doc=contract.NODES_DOC,
)
@hint("Set linear.x to forward_speed while the way is clear.")
@hint("The timer calls control ten times a second, and each call publishes exactly one command, whatever happens.")
def test_drives(judge_driving: BodyRunner, draw: random.Random) -> None:
    """navigation_controller drives forward while the way is clear, with ten commands a second."""
    distance = draw.uniform(0.9, 3.0)

    def expect_drives(system: System) -> None:
        start = system.seconds
        messages = system.publish_scans(scan(fill=distance), 2.0)
        expect_driving(messages.commands, f"With {distance:.2f} m of free space all around", SPEED, always=True)
        steering = max((abs(command.message.angular.z) for command in messages.commands), default=0.0)
        expect(
            steering <= TOLERANCE,
            f"With a clear way, the robot drove on and turned at {steering:.2f} rad/s: it should drive straight on.",
            fraction=0.5,
        )
        rate = system.harness.rate("/cmd_vel", start)
        expect(
            9.0 <= rate <= 11.0, f"{CONTROLLER} published {rate:.1f} commands a second, instead of 10.", fraction=0.5
        )

    judge_driving(expect_drives)


@check(
    points=3,
    covers=("turn", "more-room", "keeps-turn", "starts-turn", "ends-turn"),
    needs=("build",),
    after=("drives",),
)
@hint("Compare left with right when the turn begins, and remember the choice.")
@hint("The remembered turn ends when the way is clear again, not when the room on the sides changes.")
def test_turns(judge_driving: BodyRunner, draw: random.Random) -> None:
    """At an obstacle, the robot turns to the side with more room, and keeps that direction until the way is clear."""
    seed = draw.getrandbits(64)
    judge_driving(lambda system: _expect_turns(system, random.Random(seed)))


def _expect_turns(system: System, draw: random.Random) -> None:
    for side, left, right in SIDES:
        system.publish_scans(OPEN)
        commands = system.publish_scans(View(0.4, left, right).scan()).commands
        situation = (
            f"With something 0.4 m ahead, {distance_text(left)} on the left, {distance_text(right)} on the right"
        )
        expect_turning(commands, situation, side, TURN_SPEED, fraction=0.0 if math.isfinite(left - right) else 0.5)
        expect_driving(system.publish_scans(OPEN).commands, "When the way is clear again", SPEED, fraction=0.5)
    for kept_drive in KEPT_WHILE_UNTRUSTED:
        expect_drive(system, kept_drive, DRIVE, LEFT, RIGHT, fraction=0.75)
    # In some of these drives, the robot also has to stand still. This check does not judge whether it does.
    expect_each(
        turns(),
        lambda drive: expect_drive(system, drive, DRIVE, LEFT, RIGHT, fraction=0.5),
        draw,
        count=_case_count(system, 18),
    )
    expect_exact_limits(system)


def _case_count(system: System, count: int) -> int:
    """Return how many drawn drives a check can afford: fewer in real time."""
    return count if system.harness.time == LOCKSTEP else 2


@check(points=3, covers=("untrusted", "newest"), needs=("build",), after=("drives",))
@hint("If there is no clearance yet, or it is not valid or too old, publish an unchanged Twist().")
@hint(
    "The age of a clearance is self.get_clock().now() - Time.from_msg(clearance.header.stamp). The time of its arrival "
    "does not matter."
)
def test_stops(judge_driving: BodyRunner, slow_system: SharedSystem, draw: random.Random) -> None:
    """The robot stands still before the first scan, with an invalid clearance, and with a clearance that is too old."""
    seed = draw.getrandbits(64)
    judge_driving(lambda system: _expect_stops(system, slow_system, random.Random(seed)))


def _expect_stops(system: System, slow_system: SharedSystem, draw: random.Random) -> None:
    expect_still(system.before_first_scan.commands, "Before the first scan")
    system.publish_scans(OPEN)
    expect_still(system.publish_scans(BLIND).commands, "With nan from every beam ahead", fraction=0.25)
    system.publish_scans(OPEN)
    start = system.seconds
    system.wait(2.0)
    late_commands = system.messages(start + DATA_TIMEOUT + AGE_MARGIN[system.harness.time]).commands
    expect_still(late_commands, f"More than {DATA_TIMEOUT} s after the last scan", fraction=0.5)
    expect_each(
        stops(),
        lambda drive: expect_drive(system, drive, DRIVE, STILL, fraction=0.5),
        draw,
        count=_case_count(system, 10),
    )
    if system.harness.time == LOCKSTEP:  # in real time, the clocks of the machine cannot be slowed
        slow_driving_system = slow_system.get(PROCESSOR, CONTROLLER)
        slow_driving_system.publish_scans(OPEN)
        slow_driving_system.wait(DATA_TIMEOUT + AGE_MARGIN[LOCKSTEP])
        slow_commands = slow_driving_system.wait(1.0).commands
        expect_still(slow_commands, f"More than {DATA_TIMEOUT} s of ROS time after the last scan", fraction=0.75)


@check(points=1, covers="untrusted", needs=("build",), after=("drives", "stops"))
@hint("The lidar's computer has a clock of its own. A stamp that is ahead of your clock gives an age below 0.")
@hint("An age below 0 is not more than data_timeout: do not use abs().")
def test_stamp_ahead(judge_driving: BodyRunner) -> None:
    """The robot trusts a clearance whose stamp is ahead of the node's clock: it is not too old."""

    def expect_trust(system: System) -> None:
        expect_drive(system, tuple(Moment(CLEAR, 3, -lead) for lead in CLOCK_LEADS), DRIVE)
        system.wait(CLOCK_LEADS[-1])  # so that later scans also have later stamps

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
@hint("While the robot is held still, no turn begins, and a turn that has begun is remembered.")
def test_enable(judge_driving: BodyRunner, draw: random.Random) -> None:
    """The service enable holds the robot still, and lets it move again."""
    seed = draw.getrandbits(64)
    judge_driving(lambda system: _expect_enable_service(system, random.Random(seed)))


def _expect_enable_service(system: System, draw: random.Random) -> None:
    system.publish_scans(OPEN)
    expect_enabled(system, False)
    commands = system.publish_scans(OPEN, 1.7).commands
    expect_still(commands, "After a call of enable with data: false")
    pace = message_period.describe_pace(commands)
    message = f"While the robot was held still, a command was published {pace}, instead of ten times a second."
    expect(message_period.is_paced(commands, 0.1, system.harness.time), message, fraction=0.75)
    expect_enabled(system, True, fraction=0.5)
    expect_driving(system.publish_scans(OPEN).commands, "After a call of enable with data: true", SPEED, fraction=0.5)
    for kept_drive in KEPT_WHILE_HELD:
        expect_drive(system, kept_drive, STILL, DRIVE, LEFT, RIGHT, fraction=0.75)
    expect_each(
        calls(),
        lambda drive: expect_drive(system, drive, STILL, DRIVE, LEFT, RIGHT, fraction=0.5),
        draw,
        count=_case_count(system, 12),
    )
