"""Step 2, navigation_controller: driving, turning and standing still."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping

from std_srvs.srv import SetBool

from autograder.checking import LOCKSTEP, expect, group, hint
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, expect_exact_limits
from autograder.checks.ch08_capstone.hidden.fallback import BodyRunner
from autograder.checks.ch08_capstone.hidden.standstill import beside, expect_turn_kept
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR
from autograder.checks.ch08_capstone.support.expectations import expect_driving, expect_still, expect_turning
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

check = group("step_2")
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN = PARAMETERS[CONTROLLER]["turn_speed"].default
SAFETY_DISTANCE = PARAMETERS[CONTROLLER]["safety_distance"].default
DATA_TIMEOUT = PARAMETERS[CONTROLLER]["data_timeout"].default
MARGIN = 0.09  # s around a time-out, slightly less than the period of the commands
REAL_MARGIN = 0.25  # s, in real time
CLOCK_AHEAD = 1.0  # s, longer than the time-out
SAFETY_MARGIN = 0.03  # m around the safety distance, a twentieth of it
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
    distances = draw_distances(draw)
    judge_driving(lambda driving: _expect_turns(driving, distances))


def draw_distances(draw: random.Random) -> dict[str, tuple[float, float]]:
    """Return for a turn to each side the distances, in metres, of a thing ahead and of one on the other side."""
    return {side: (draw.uniform(0.25, SAFETY_DISTANCE - 0.1), draw.uniform(0.7, 1.2)) for side in ("left", "right")}


def _expect_turns(driving: System, distances: Mapping[str, tuple[float, float]]) -> None:
    """Fail the check unless the robot turns correctly with things at these distances, drawn by `draw_distances`."""
    for side, (distance, narrow_distance) in distances.items():
        sign = 1.0 if side == "left" else -1.0
        driving.publish_scans(OPEN)
        obstacle = Part(-10.0, 10.0, distance)
        narrow_side, narrower_side = beside(-sign, narrow_distance), beside(sign, narrow_distance - 0.4)
        situation = f"With something {distance:.2f} m ahead and less room on the {'right' if sign > 0 else 'left'}"
        expect_turning(driving.publish_scans(scan(obstacle, narrow_side)).commands, situation, side, TURN)
        later = f"{situation}, once it turns and the sides have changed,"
        expect_turning(
            driving.publish_scans(scan(obstacle, narrow_side, narrower_side)).commands, later, side, TURN, fraction=0.5
        )
        expect_driving(driving.publish_scans(OPEN).commands, "When the way is clear again", SPEED, fraction=0.5)
    for distance in (SAFETY_DISTANCE + SAFETY_MARGIN, SAFETY_DISTANCE - SAFETY_MARGIN):
        driving.publish_scans(OPEN)
        # There is as much room on the left as on the right.
        commands = driving.publish_scans(scan(Part(-10.0, 10.0, distance), fill=math.inf)).commands
        situation = f"With something {distance:.2f} m ahead, and a safety distance of {SAFETY_DISTANCE:.2f} m"
        if distance > SAFETY_DISTANCE:
            expect_driving(commands, situation, SPEED, fraction=0.5)
        else:
            expect_turning(commands, situation, "left", TURN, fraction=0.5)
    expect_exact_limits(driving)
    expect_turn_kept(driving, lambda: driving.publish_scans(BLIND), "When it saw again after nan from every beam ahead")


@check(points=3, covers=("untrusted", "newest"), needs=("build",), after=("drives",))
@hint("No clearance yet, one that is not valid, one that is too old: publish Twist() as it is.")
@hint("Its age is self.get_clock().now() - Time.from_msg(clearance.header.stamp), however late it came.")
def test_stops(judge_driving: BodyRunner, slow_system: SharedSystem) -> None:
    """It stands still before the first scan, with an invalid clearance, and with one that is too old."""
    judge_driving(lambda driving: _expect_stops(driving, slow_system))


def _expect_stops(driving: System, slow_system: SharedSystem) -> None:
    expect_still(driving.before_first_scan.commands, "Before the first scan")
    driving.publish_scans(OPEN)
    expect_still(driving.publish_scans(BLIND).commands, "With nan from every beam ahead", fraction=0.25)
    driving.publish_scans(OPEN)
    margin = MARGIN if driving.harness.time == LOCKSTEP else REAL_MARGIN
    start = driving.seconds
    driving.wait(2.0)
    early_commands = driving.messages(start, start + DATA_TIMEOUT - margin).commands
    expect_driving(early_commands, f"Less than {DATA_TIMEOUT} s after the last scan", SPEED, fraction=0.5, always=True)
    late_commands = driving.messages(start + DATA_TIMEOUT + margin).commands
    expect_still(late_commands, f"More than {DATA_TIMEOUT} s after the last scan", fraction=0.5)
    driving.publish_scans(OPEN)
    commands = driving.publish_scans(OPEN, 1.5, age=1.0).commands
    expect_still(commands[-5:], "With scans that come late, 1.0 s after they were taken,", fraction=0.75)
    if driving.harness.time == LOCKSTEP:  # in real time, the clocks of the machine cannot be slowed
        slow_driving = slow_system.get(PROCESSOR, CONTROLLER)
        slow_driving.publish_scans(OPEN)
        slow_driving.wait(DATA_TIMEOUT + margin)
        slow_commands = slow_driving.wait(1.0).commands
        expect_still(slow_commands, f"More than {DATA_TIMEOUT} s of ROS time after the last scan", fraction=0.75)


@check(points=1, covers="untrusted", needs=("build",), after=("drives", "stops"))
@hint("The lidar's computer has a clock of its own. A stamp that is ahead of yours gives an age below 0.")
@hint("An age below 0 is not more than data_timeout: no abs().")
def test_stamp_ahead(judge_driving: BodyRunner) -> None:
    """It trusts a clearance whose stamp is ahead of its clock: that is not old."""
    situation = f"With scans whose stamp is {CLOCK_AHEAD} s ahead of the clock"
    judge_driving(
        lambda driving: expect_driving(driving.publish_scans(OPEN, 1.5, age=-CLOCK_AHEAD).commands, situation, SPEED)
    )


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
def test_enable(judge_driving: BodyRunner) -> None:
    """The service enable holds the robot still, and lets it go again."""
    judge_driving(_expect_enable_service)


def _expect_enable_service(system: System) -> None:
    system.publish_scans(OPEN)
    response = system.call(SetBool, "/enable", SetBool.Request(data=True))
    expect(response.success, "Asked to drive while it drove, it answered success = false.", fraction=0.5)
    response = system.call(SetBool, "/enable", SetBool.Request(data=False))
    expect(response.success, "Asked to hold still, it answered success = false.")
    commands = system.publish_scans(OPEN, 1.7).commands
    expect_still(commands, "After enable with data: false")
    message = f"Held still, it published a command {message_period.describe_pace(commands)}, instead of ten a second."
    expect(message_period.is_paced(commands, 0.1, system.harness.time), message, fraction=0.75)
    response = system.call(SetBool, "/enable", SetBool.Request(data=True))
    expect(response.success, "Asked to drive again, it answered success = false.", fraction=0.5)
    expect_driving(system.publish_scans(OPEN).commands, "After enable with data: true", SPEED, fraction=0.5)
    expect_turn_kept(system, lambda: _disable_and_enable(system), "Let go after it was held still")


def _disable_and_enable(system: System) -> None:
    """Disable the robot for a moment, then enable it."""
    system.call(SetBool, "/enable", SetBool.Request(data=False))
    system.publish_scans(OPEN)  # the way is clear for a moment; a turn must not end while the robot stands still
    system.call(SetBool, "/enable", SetBool.Request(data=True))
