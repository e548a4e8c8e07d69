"""Step 2, navigation_controller: how it drives, turns and stands still."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping

from std_srvs.srv import SetBool

from autograder.checking import LOCKSTEP, expect, group, hint
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN, expect_exact_limits
from autograder.checks.ch08_capstone.hidden.judges import JudgeDriving
from autograder.checks.ch08_capstone.hidden.standstill import beside, expect_turn_kept
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PARAMETERS, PROCESSOR
from autograder.checks.ch08_capstone.support.system import (
    SharedSystem,
    System,
    expect_driving,
    expect_still,
    expect_turning,
)

check = group("step_2")
SPEED = PARAMETERS[CONTROLLER]["forward_speed"].default
TURN = PARAMETERS[CONTROLLER]["turn_speed"].default
NEAR = PARAMETERS[CONTROLLER]["safety_distance"].default
STALE = PARAMETERS[CONTROLLER]["data_timeout"].default
MARGIN = 0.09  # s around a time-out, a little less than the time between two commands
REAL_MARGIN = 0.25  # s, where time is real
AHEAD = 1.0  # s, more than a time-out
EDGE = 0.03  # m around the safety distance, a twentieth of it
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
def test_drives(judge_driving: JudgeDriving, draw: random.Random) -> None:
    """It drives forward while the way is clear, with ten commands a second."""
    distance = draw.uniform(0.9, 3.0)

    def judge(driving: System) -> None:
        began = driving.seconds
        said = driving.see(scan(fill=distance), 2.0)
        expect_driving(said.commands, f"With {distance:.2f} m of free space all around", SPEED, always=True)
        rate = driving.harness.rate("/cmd_vel", began)
        expect(9.0 <= rate <= 11.0, f"It published {rate:.1f} commands a second, instead of 10.", fraction=0.5)

    judge_driving(judge)


@check(
    points=3,
    covers=("turn", "more-room", "keeps-turn", "starts-turn", "ends-turn"),
    needs=("build",),
    after=("drives",),
)
@hint("Compare left with right when the turn begins, and remember the choice.")
@hint("The remembered turn ends when the way is clear again, not when the sides look different.")
def test_turns(judge_driving: JudgeDriving, draw: random.Random) -> None:
    """In front of an obstacle it turns towards the side with more room, and keeps the direction until it is clear."""
    rooms = draw_rooms(draw)
    judge_driving(lambda driving: _expect_turns(driving, rooms))


def draw_rooms(draw: random.Random) -> dict[str, tuple[float, float]]:
    """Return for each side how near something is ahead, and how much room there is on the other side, in metres."""
    return {side: (draw.uniform(0.25, NEAR - 0.1), draw.uniform(0.7, 1.2)) for side in ("left", "right")}


def _expect_turns(driving: System, rooms: Mapping[str, tuple[float, float]]) -> None:
    """Judge the turns to each side, with something so near ahead and so much room on the other side, in metres."""
    for side, (near, tight) in rooms.items():
        sign = 1.0 if side == "left" else -1.0
        driving.see(OPEN)
        obstacle = Part(-10.0, 10.0, near)
        narrow, other = beside(-sign, tight), beside(sign, tight - 0.4)
        situation = f"With something {near:.2f} m ahead and less room on the {'right' if sign > 0 else 'left'}"
        expect_turning(driving.see(scan(obstacle, narrow)).commands, situation, side, TURN)
        later = f"{situation}, once it turns and the sides have changed,"
        expect_turning(driving.see(scan(obstacle, narrow, other)).commands, later, side, TURN, fraction=0.5)
        expect_driving(driving.see(OPEN).commands, "When the way is clear again", SPEED, fraction=0.5)
    for near in (NEAR + EDGE, NEAR - EDGE):
        driving.see(OPEN)
        said = driving.see(scan(Part(-10.0, 10.0, near), fill=math.inf)).commands  # the same room on both sides
        situation = f"With something {near:.2f} m ahead, and a safety distance of {NEAR:.2f} m"
        if near > NEAR:
            expect_driving(said, situation, SPEED, fraction=0.5)
        else:
            expect_turning(said, situation, "left", TURN, fraction=0.5)
    expect_exact_limits(driving)
    expect_turn_kept(driving, lambda: driving.see(BLIND), "When it saw again after nan from every beam ahead")


@check(points=3, covers=("untrusted", "newest"), needs=("build",), after=("drives",))
@hint("No clearance yet, one that is not valid, one that is too old: publish Twist() as it is.")
@hint("Its age is self.get_clock().now() - Time.from_msg(clearance.header.stamp), however late it came.")
def test_stops(judge_driving: JudgeDriving, slow_system: SharedSystem) -> None:
    """It stands still before the first scan, with an invalid clearance, and with one that is too old."""
    judge_driving(lambda driving: _expect_stops(driving, slow_system))


def _expect_stops(driving: System, slow_system: SharedSystem) -> None:
    expect_still(driving.first.commands, "Before the first scan")
    driving.see(OPEN)
    expect_still(driving.see(BLIND).commands, "With nan from every beam ahead", fraction=0.25)
    driving.see(OPEN)
    margin = MARGIN if driving.harness.time == LOCKSTEP else REAL_MARGIN
    began = driving.seconds
    driving.wait(2.0)
    fresh = driving.messages(began, began + STALE - margin).commands
    expect_driving(fresh, f"Less than {STALE} s after the last scan", SPEED, fraction=0.5, always=True)
    late = driving.messages(began + STALE + margin).commands
    expect_still(late, f"More than {STALE} s after the last scan", fraction=0.5)
    driving.see(OPEN)
    old = driving.see(OPEN, 1.5, age=1.0).commands
    expect_still(old[-5:], "With scans that come late, 1.0 s after they were taken,", fraction=0.75)
    if driving.harness.time == LOCKSTEP:  # elsewhere the machine's clocks are as they are
        slow = slow_system.get(PROCESSOR, CONTROLLER)
        slow.see(OPEN)
        slow.wait(STALE + margin)
        still = slow.wait(1.0).commands
        expect_still(still, f"More than {STALE} s of ROS time after the last scan", fraction=0.75)


@check(points=1, covers="untrusted", needs=("build",), after=("drives", "stops"))
@hint("The lidar's computer has a clock of its own. A stamp that is ahead of yours gives an age below 0.")
@hint("An age below 0 is not more than data_timeout: no abs().")
def test_stamp_ahead(judge_driving: JudgeDriving) -> None:
    """It trusts a clearance whose stamp is ahead of its clock: that is not old."""
    situation = f"With scans whose stamp is {AHEAD} s ahead of the clock"
    judge_driving(lambda driving: expect_driving(driving.see(OPEN, 1.5, age=-AHEAD).commands, situation, SPEED))


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
def test_enable(judge_driving: JudgeDriving) -> None:
    """The service enable holds the robot still, and lets it go again."""
    judge_driving(_hold_and_release)


def _hold_and_release(system: System) -> None:
    system.see(OPEN)
    answer = system.call(SetBool, "/enable", SetBool.Request(data=True))
    expect(answer.success, "Asked to drive while it drove, it answered success = false.", fraction=0.5)
    answer = system.call(SetBool, "/enable", SetBool.Request(data=False))
    expect(answer.success, "Asked to hold still, it answered success = false.")
    held = system.see(OPEN, 1.7).commands
    expect_still(held, "After enable with data: false")
    said = f"Held still, it published a command {message_period.describe_pace(held)}, instead of ten a second."
    expect(message_period.is_paced(held, 0.1, system.harness.time), said, fraction=0.75)
    answer = system.call(SetBool, "/enable", SetBool.Request(data=True))
    expect(answer.success, "Asked to drive again, it answered success = false.", fraction=0.5)
    expect_driving(system.see(OPEN).commands, "After enable with data: true", SPEED, fraction=0.5)
    expect_turn_kept(system, lambda: _hold(system), "Let go after it was held still")


def _hold(system: System) -> None:
    """Hold the robot still for a moment, and let it go."""
    system.call(SetBool, "/enable", SetBool.Request(data=False))
    system.see(OPEN)  # the way is clear for a moment, and no turn ends while it stands still
    system.call(SetBool, "/enable", SetBool.Request(data=True))
