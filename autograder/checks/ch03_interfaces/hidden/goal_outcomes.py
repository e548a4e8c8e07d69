"""Checks of the action drive_distance: cancelled and aborted goals, and one goal at a time."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from hypothesis import strategies as st

from autograder.checking import LOCKSTEP, REAL, Goal, ReceivedMessage, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checks.ch03_interfaces.hidden.action import MOTION_CHECK, SERVER_CHECK, drives_straight
from autograder.checks.ch03_interfaces.hidden.arrival import LONG_SECONDS, STATUS_NAMES
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import MAX_REASON, PATIENCE
from autograder.checks.ch03_interfaces.support.driver import COMMANDS, STEP, Driver, has_stopped

check = group("action", doc=contract.ACTION)
LATE = {LOCKSTEP: 0.4, REAL: 2.0}  # s beyond PATIENCE: two commands, and the harness's steps until the result
TOLERANCE = {LOCKSTEP: 0.05, REAL: 0.25}  # s, or m: how wrong the time of a command, or a distance, may be
PUSH_AFTER = 0.5  # s from the start of a goal to the push
FIRST_SPEED = 0.3  # m/s of a goal during which others are sent
HEIGHT = 1.0  # m of height, which must not count as distance
TOO_LITTLE, ENOUGH = 0.0095, 0.0105  # m: just below and just above a centimetre
SLOW = 0.007  # m/s, less than a centimetre in 1 s
ROLL_BACK = 0.015  # m in each step, far more than a centimetre in 1 s
REACHED, CANCELLED, CANCELLED_AT_ONCE, STUCK = "reached", "cancelled", "cancelled before it moved", "given up"
CANCELS = st.tuples(st.integers(0, 5), st.booleans())  # tenths of a second, and whether the wheels are held
ENDINGS = (REACHED, CANCELLED, CANCELLED_AT_ONCE, STUCK)  # the ways in which goals end
SHORT_DISTANCE, LOW_SPEED = 0.04, 0.015  # m, m/s: a little more than a centimetre in 1 s


@check(points=3, covers=("cancels", "stop"), needs=SERVER_CHECK, after=MOTION_CHECK)
@hint("Check goal_handle.is_cancel_requested in each pass of the loop: stop, then goal_handle.canceled().")
@hint("cancel_callback must return CancelResponse.ACCEPT. Without a cancel_callback, every cancel is rejected.")
def test_drive_cancels(placed_driver: Driver, draw: random.Random) -> None:
    """A cancel stops the robot immediately. The goal ends CANCELED, and the result has the distance and a reason."""
    x, y = placed_driver.x, placed_driver.y
    goal = placed_driver.start(4.5, 0.5)
    placed_driver.roll(goal, LONG_SECONDS, until=lambda: math.dist((x, y), (placed_driver.x, placed_driver.y)) > 0.5)
    cancel_position = placed_driver.x, placed_driver.y
    goal.cancel()
    commands = placed_driver.roll(goal, 3.0)
    expect(goal.cancelled is True, "The cancel was not accepted within 3 s.")
    expect(goal.result is not None, "The cancel was accepted, but 3 s later the goal had not ended.", fraction=0.2)
    outcome = STATUS_NAMES.get(goal.status, goal.status)
    is_cancelled = goal.status == GoalStatus.STATUS_CANCELED
    expect(is_cancelled, f"After a cancel, the goal ended {outcome}, not CANCELED.", fraction=0.2)
    expect(has_stopped(commands), "After the cancel, the last command was not a stop.", fraction=0.7)
    overrun = math.dist(cancel_position, (placed_driver.x, placed_driver.y))
    expect(overrun <= 0.3, f"After the cancel, the robot drove on for {overrun:.2f} m.", fraction=0.3)
    driven = math.dist((x, y), (placed_driver.x, placed_driver.y))
    expect(
        abs(goal.result.driven - driven) <= 0.15,
        f"In the result, driven is {goal.result.driven:.2f} m, but the robot drove {driven:.2f} m.",
        fraction=0.7,
    )
    expect(goal.result.reason.strip() != "", "The reason in the result is empty.", fraction=0.8)
    expect_each(
        CANCELS,
        lambda drawn: _expect_cancelled(placed_driver, *drawn),
        draw,
        count=4 if placed_driver.time == LOCKSTEP else 1,
    )


def _expect_cancelled(driver: Driver, tenths: int, is_held: bool) -> None:
    """Fail the check unless a cancel, some tenths of a second after the start, ends a goal with a stop and a reason."""
    x, y = driver.x, driver.y
    goal = driver.start(4.5, 0.5)
    driver.is_stuck = is_held
    if tenths:
        driver.roll(goal, tenths / 10.0)
    goal.cancel()
    driver.roll(goal, 3.0)
    driver.is_stuck = False
    situation = f"With a cancel {tenths / 10.0:.1f} s after the start{' and wheels that do not turn' * is_held}"
    outcome = f"ended {STATUS_NAMES[goal.status]}" if goal.status in STATUS_NAMES else "did not end"
    is_cancelled = goal.result is not None and goal.status == GoalStatus.STATUS_CANCELED
    expect(is_cancelled, f"{situation}, the goal {outcome}: it should end CANCELED.", fraction=0.5)
    commands = [received.message for received in driver.commands()]
    expect(has_stopped(commands), f"{situation}, the last command was not a stop.", fraction=0.7)
    driven, reported_distance = math.dist((x, y), (driver.x, driver.y)), goal.result.driven
    expect(
        abs(reported_distance - driven) <= 0.15,
        f"{situation}, driven is {reported_distance:.2f} m in the result, but the robot drove {driven:.2f} m.",
        fraction=0.7,
    )
    expect(goal.result.reason.strip() != "", f"{situation}, the reason in the result is empty.", fraction=0.8)


@check(points=2, covers=("busy", "next-goal", "drive-cmd-vel"), needs=SERVER_CHECK, after=("drive_cancels",))
@hint("When you accept a goal, remember that it is being driven, until it has ended.")
@hint("self.busy.acquire(blocking=False) in accept, self.busy.release() at the end of execute.")
def test_drive_one_at_a_time(placed_driver: Driver, draw: random.Random) -> None:
    """While a goal is driven, another one is rejected and the first one continues. The next one is then accepted."""
    overlap = _send_other_goals(placed_driver)
    expect(not overlap.accepted[0], "While a goal was driven, another one was accepted.")
    is_any_accepted = any(overlap.accepted)
    expect(
        not is_any_accepted,
        "While a goal was driven, another one was rejected, but the one after it was accepted.",
        fraction=0.75,
    )
    expect(overlap.is_running, "The first goal ended when another one was sent.", fraction=0.3)
    is_undisturbed = bool(overlap.later_commands) and all(
        drives_straight(command, overlap.speed) for command in overlap.later_commands
    )
    expect(is_undisturbed, "The robot did not continue with the first goal when another one was sent.", fraction=0.3)
    ending = f"{CANCELLED} or {STUCK}"
    for next_ending in (*draw.sample(ENDINGS, len(ENDINGS)), REACHED):  # another goal comes after each way
        goal = placed_driver.send(0.1 if next_ending == REACHED else 3.0, 0.5)
        expect(goal.accepted is True, f"After a goal had been {ending}, the next one was rejected.", fraction=0.5)
        ending = next_ending
        if not _end_goal(placed_driver, goal, next_ending):
            break  # other checks test whether a goal ends
    is_first_goal = all(drives_straight(command, overlap.speed) for command in overlap.commands)
    expect(is_first_goal, "After a rejected goal, a command did not belong to the first goal.", fraction=0.75)


@check(points=2, covers=("stuck", "stop-in-time", "slow-goal", "driven"), needs=SERVER_CHECK, after=MOTION_CHECK)
@hint("Remember the distance and the time of the last progress. Each further centimetre updates both.")
@hint("If self.get_clock().now() - progress_time > PATIENCE, stop, abort, and give a reason.")
def test_drive_stuck(placed_driver: Driver) -> None:
    """A robot that makes no progress for a second is stopped, and the goal ends ABORTED with a reason."""
    placed_driver.is_stuck, tolerance = True, TOLERANCE[placed_driver.time]
    goal, commands = _push(placed_driver, TOO_LITTLE)
    outcome = STATUS_NAMES.get(goal.status, goal.status)
    is_aborted = goal.status == GoalStatus.STATUS_ABORTED
    expect(is_aborted, f"With wheels that do not turn, the goal ended {outcome}, not ABORTED.")
    seconds = _driving_seconds(commands)
    slack = tolerance if placed_driver.time == LOCKSTEP else LATE[REAL]
    expect(
        PATIENCE - contract.PERIOD - tolerance <= seconds <= PATIENCE + slack,
        f"With wheels that do not turn, the robot was told to drive for {seconds:.2f} s, not {PATIENCE:.0f} s.",
        fraction=0.5,
    )
    twists = [received.message for received in commands]
    expect(has_stopped(twists), "When the goal was given up, the last command was not a stop.", fraction=0.7)
    expect(goal.result.reason.strip() != "", "The reason in the result is empty.", fraction=0.7)
    _, commands = _push(placed_driver, ENOUGH)
    seconds = _driving_seconds(commands)
    expect(
        seconds >= PUSH_AFTER + PATIENCE - contract.PERIOD - tolerance,
        f"The robot moved {ENOUGH:.4f} m after {PUSH_AFTER} s, but the goal was given up at {seconds:.2f} s.",
        fraction=0.7,
    )
    goal, distance = _roll_back(placed_driver)
    is_rolling_aborted = goal.status == GoalStatus.STATUS_ABORTED
    expect(
        is_rolling_aborted, "The robot rolled back, which is not progress, but its goal was not given up.", fraction=0.7
    )
    message = f"The robot rolled back to {distance:.2f} m, but driven is {goal.result.driven:.2f} m in the result."
    expect(abs(goal.result.driven - distance) <= tolerance, message, fraction=0.75)
    placed_driver.is_stuck = False
    goal = placed_driver.start(1.0, SLOW)
    placed_driver.finish(goal, 6.0, f"At {SLOW} m/s, which is slower than 0.01 m/s")
    outcome = STATUS_NAMES.get(goal.status, goal.status)
    is_slow_aborted = goal.status == GoalStatus.STATUS_ABORTED
    expect(is_slow_aborted, f"At {SLOW} m/s, less than a centimetre in 1 s, the goal ended {outcome}.", fraction=0.7)
    goal = placed_driver.start(SHORT_DISTANCE, LOW_SPEED)
    placed_driver.finish(goal, LONG_SECONDS, f"At {LOW_SPEED} m/s")
    outcome = STATUS_NAMES.get(goal.status, goal.status)
    has_succeeded = goal.status == GoalStatus.STATUS_SUCCEEDED
    expect(has_succeeded, f"At {LOW_SPEED} m/s, more than a centimetre in 1 s, the goal ended {outcome}.", fraction=0.7)


@check(points=2, covers=("stuck", "drive-time", "driven", "result-reason"), needs=SERVER_CHECK, after=("drive_stuck",))
@hint("Without odometry, the position does not change, which is not progress, either.")
@hint("time.sleep() and time.monotonic() do not use ROS time. self.get_clock() does.")
def test_drive_blind(slow_clock_driver: Driver) -> None:
    """If the odometry falls silent, the robot is stopped after 1 s of ROS time, and the goal ends ABORTED."""
    goal = slow_clock_driver.start(4.5, 0.5)
    slow_clock_driver.roll(goal, 0.6)
    slow_clock_driver.height = HEIGHT
    # Publish the pose, so that the driver knows it exactly.
    slow_clock_driver.place(slow_clock_driver.x, slow_clock_driver.y, slow_clock_driver.heading)
    driven = math.hypot(slow_clock_driver.x, slow_clock_driver.y)  # the start is (0, 0)
    slow_clock_driver.is_silent, silence_start = True, slow_clock_driver.seconds
    commands = slow_clock_driver.finish(goal, LONG_SECONDS, "With odometry that fell silent")
    seconds = slow_clock_driver.seconds - silence_start
    outcome = STATUS_NAMES.get(goal.status, goal.status)
    is_aborted = goal.status == GoalStatus.STATUS_ABORTED
    expect(is_aborted, f"With odometry that fell silent, the goal ended {outcome}, not ABORTED.")
    expect(has_stopped(commands), "When the goal was given up, the last command was not a stop.", fraction=0.75)
    is_late = seconds > PATIENCE + LATE[slow_clock_driver.time]
    message = f"The goal was given up {seconds:.1f} s of ROS time after the last odometry, instead of 1 s."
    expect(not is_late, message, fraction=0.5)
    reported_distance = goal.result.driven
    message = (
        f"The last odometry was {driven:.2f} m away from the start and {HEIGHT:g} m higher, "
        f"but driven is {reported_distance:.2f} m in the result."
    )
    expect(abs(reported_distance - driven) <= 0.1, message, fraction=0.75)
    length = len(goal.result.reason)
    expect(length <= MAX_REASON, f"The reason has {length} characters, instead of at most {MAX_REASON}.", fraction=0.75)


@dataclass(frozen=True)
class _OverlappingGoals:
    """The results of other goals that were sent while a first goal was driven."""

    speed: float  # m/s at which the first goal was driven before the others were sent
    accepted: list[bool]  # whether each of the others was accepted
    is_running: bool  # whether the first goal had not ended
    later_commands: list[Twist]  # the commands after each answer to one of the others
    commands: list[Twist]  # all commands since the first of the others was sent


def _send_other_goals(driver: Driver) -> _OverlappingGoals:
    """Drive a goal, send other goals meanwhile, and abandon all of them."""
    first = driver.start(4.5, FIRST_SPEED)
    first_commands = driver.roll(first, 0.3)
    expect(bool(first_commands), "A goal was accepted, but no command was published on cmd_vel.")
    command_count, other_goals, later_commands = len(driver.messages(COMMANDS)), list[Goal](), list[Twist]()
    for distance in (1.0, -1.0, 1.0):  # whichever is rejected, and why, the first goal keeps the robot
        other_goals.append(driver.send(distance, 0.5))
        later_commands += driver.roll(first, 0.2)
    commands = [received.message for received in driver.messages(COMMANDS)[command_count:]]
    is_running = first.result is None
    for goal in (first, *other_goals):
        if goal.accepted:
            driver.abandon(goal)
    return _OverlappingGoals(
        first_commands[-1].linear.x,
        [bool(goal.accepted) for goal in other_goals],
        is_running,
        later_commands,
        commands,
    )


def _end_goal(driver: Driver, goal: Goal, ending: str) -> bool:
    """End a goal in this way, or abandon it if that fails; return whether it has ended."""
    driver.is_stuck = ending == STUCK
    if ending == CANCELLED:
        driver.roll(goal, 0.2)
    if ending in (CANCELLED, CANCELLED_AT_ONCE):
        goal.cancel()
    driver.roll(goal, 3.0)
    driver.is_stuck = False
    if goal.result is None:
        driver.abandon(goal)
    return goal.result is not None


def _push(driver: Driver, distance: float) -> tuple[Goal, list[ReceivedMessage]]:
    """Push a robot with held wheels once during a goal; return the goal, which has ended, and its commands."""
    goal = driver.start(1.0, 0.4)
    driver.roll(goal, PUSH_AFTER)
    driver.shift(distance)
    driver.finish(goal, 6.0, "With wheels that do not turn")
    return goal, driver.commands()


def _roll_back(driver: Driver) -> tuple[Goal, float]:
    """Hold the wheels of a driving robot and roll it back; return its goal, and how far it is from its start, in m."""
    driver.is_stuck = False
    x, y = driver.x, driver.y
    goal = driver.start(4.5, 0.5)
    driver.roll(goal, 1.0)
    driver.is_stuck, deadline = True, driver.seconds + PATIENCE + LATE[driver.time]
    while goal.result is None and driver.seconds < deadline:
        driver.shift(-ROLL_BACK)
        driver.roll(goal, STEP)
    distance = math.dist((x, y), (driver.x, driver.y))
    driver.abandon(goal)
    return goal, distance


def _driving_seconds(commands: list[ReceivedMessage]) -> float:
    """Return the seconds from the first to the last command that drives."""
    times = [received.seconds for received in commands if received.message.linear.x != 0.0]
    return times[-1] - times[0] if times else 0.0
