"""Checks of the action drive_distance: accepted goals, the robot's motion, feedback and results."""

from __future__ import annotations

import math
import random

from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from rclpy.action import get_action_names_and_types
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from autograder.checking import LOCKSTEP, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checking.probes import message_period
from autograder.checks.ch03_interfaces.hidden.arrival import LONG_SECONDS, STATUS_NAMES, expect_exact_arrival
from autograder.checks.ch03_interfaces.hidden.goals import INVALID_ALONE, INVALID_GOALS, PLAIN_DISTANCE, VALID_GOALS
from autograder.checks.ch03_interfaces.support import contract
from autograder.checks.ch03_interfaces.support.contract import MAX_DISTANCE, MAX_SPEED
from autograder.checks.ch03_interfaces.support.driver import (
    ACTION,
    COMMANDS,
    ODOMETRY,
    Driver,
    has_stopped,
    is_remaining,
)
from autograder.checks.ch03_interfaces.support.driver_qos import expect_volatile

check = group("action")
SERVER_CHECK, MOTION_CHECK = ("drive_serves",), ("drive_moves",)
SLACK = 0.02  # m, and m/s: 10 % of the default speed
PUSH = 0.2  # m that the robot is pushed back; it makes up for this within a second
# s after a push, when feedback has arrived and the robot has made up for less than half of the push.
FEEDBACK_SECONDS = 0.25
SILENCE = 2.0  # s without odometry before a goal
DISCOVERY_SECONDS = 5.0  # s of real time until an action is in the graph
HOLD_SECONDS = 0.8  # s for which the wheels are held, too short for the goal to be aborted
EXECUTOR_HINTS = (
    "While execute runs in its loop, other callbacks need another thread: spin with a MultiThreadedExecutor.",
    "main, which is given, spins a MultiThreadedExecutor. Keep it as it is.",
)


@check(points=1, covers="drive-action", needs=("builds", "drive_distance"), after=("generated",), doc=contract.ACTION)
@hint("Start it with ros2 run my_robot_package distance_driver and read the last lines of its output.")
@hint("ActionServer(self, DriveDistance, 'drive_distance', execute_callback=..., ...) in __init__.")
def test_drive_serves(driver: Driver) -> None:
    """The program distance_driver starts and serves the action drive_distance."""
    actions: dict[str, list[str]] = {}

    def is_served() -> bool:
        actions.update(get_action_names_and_types(driver.node))
        return ACTION in actions

    has_action = driver.wait_for(is_served, DISCOVERY_SECONDS)
    expect(has_action, f"There is no action {ACTION}; the node serves {', '.join(sorted(actions)) or 'no action'}.")
    expected = f"{contract.INTERFACES}/action/DriveDistance"
    message = f"{ACTION} has the type {', '.join(actions[ACTION])} instead of {expected}."
    expect(actions[ACTION] == [expected], message)


@check(points=1, covers=("drive-node", "no-odometry", "drive-cmd-vel"), needs=SERVER_CHECK, doc=contract.ACTION)
@hint("Start with self.position = None, and reject goals while it is None.")
@hint("Publish on cmd_vel only while a goal is driven. Without a goal, do not publish a stop, either.")
def test_drive_needs_odometry(driver: Driver) -> None:
    """Its node distance_driver rejects goals before the first odometry, and publishes on cmd_vel only during a goal."""
    goal = driver.send(1.0)
    if goal.accepted:
        driver.abandon(goal)
    expect(not goal.accepted, "A goal was accepted before the first odometry.")
    expect(not driver.messages(COMMANDS), "A command was published on cmd_vel before the first odometry.")
    driver.place(0.0, 0.0, 0.0)
    driver.run(0.3)
    count = len(driver.messages(COMMANDS))
    message = f"After the first odometry and before any goal, {count} commands were published on cmd_vel."
    expect(count == 0, message, fraction=0.5)
    goal = driver.send(1.0, 0.2)
    if goal.accepted:
        driver.abandon(goal)
    message = "After the first odometry, a goal of 1 m at 0.2 m/s was rejected."
    expect(goal.accepted is True, message, fraction=0.5)
    names = driver.nodes()
    message = f"There is no node /{contract.DRIVER}. Nodes in the graph: {', '.join(names) or 'none'}."
    expect(f"/{contract.DRIVER}" in names, message, fraction=0.5)


@check(points=2, covers=("drives", "drive-cmd-vel"), needs=SERVER_CHECK, doc=contract.GROUPS)
@hint(*EXECUTOR_HINTS)
def test_drive_moves(placed_driver: Driver, draw: random.Random) -> None:
    """An accepted goal drives the robot straight on at the goal's speed, with ten commands a second."""
    speed = draw.uniform(0.3, 0.45)
    goal = placed_driver.start(3.0, speed)
    start = placed_driver.seconds
    commands = placed_driver.roll(goal, 0.6)
    seconds = placed_driver.seconds - start
    placed_driver.abandon(goal)
    expect(bool(commands), "The goal was accepted, but no command was published on cmd_vel.")
    wrong_commands = [command for command in commands if not drives_straight(command, speed)]
    wrong_command = _describe(wrong_commands[0]) if wrong_commands else ""
    expect(not wrong_commands, f"The goal's speed is {speed:.2f} m/s, but the robot was told {wrong_command}.")
    rate = len(commands) / seconds
    expect(rate <= 20.0, f"It published {rate:.0f} commands a second, instead of 10.", fraction=0.5)


@check(
    points=2,
    covers=("arrives", "stop", "odom", "overshoot", "drives"),
    needs=SERVER_CHECK,
    after=MOTION_CHECK,
    doc=contract.ACTION,
)
@hint(*EXECUTOR_HINTS)
def test_drive_succeeds(placed_driver: Driver, draw: random.Random) -> None:
    """The goal succeeds once the robot has driven the distance, whatever its heading, and the robot stops."""
    for speed, least in ((0.5, 1.8), (0.4, 1.5)):
        distance = draw.uniform(least, least + 0.2)  # 10 % of it is more than the tolerance
        x, y = placed_driver.x, placed_driver.y
        goal = placed_driver.start(distance, speed)
        commands = placed_driver.finish(goal, LONG_SECONDS, f"With {distance:.2f} m to drive")
        driven = math.dist((x, y), (placed_driver.x, placed_driver.y))
        outcome = f"{STATUS_NAMES.get(goal.status, goal.status)}.{placed_driver.abort_reason()}"
        message = f"After {driven:.2f} m of {distance:.2f} m, the goal ended {outcome}"
        expect(goal.status == GoalStatus.STATUS_SUCCEEDED, message)
        limit = distance + 3 * contract.PERIOD * speed + SLACK
        expect(distance - SLACK <= driven <= limit, f"With {distance:.2f} m to drive, the robot drove {driven:.2f} m.")
        expect(has_stopped(commands), "When the goal ended, the last command was not a stop.", fraction=0.5)
        first_speed = commands[0].linear.x  # `drive_moves` tests whether it is the goal's speed
        moves = [command for command in commands if command.linear.x != 0.0]
        other_moves = [command for command in moves if not drives_straight(command, first_speed)]
        other_move = _describe(other_moves[0]) if other_moves else ""
        message = f"At the start, the robot was told to drive at {first_speed:.2f} m/s, and later {other_move}."
        expect(not other_moves, message, fraction=0.5)
        placed_driver.place(placed_driver.x, placed_driver.y, placed_driver.heading + math.pi / 2.0)


@check(
    points=2,
    covers=("driven", "arrives", "drive-cmd-vel", "odom"),
    needs=SERVER_CHECK,
    after=("drive_succeeds",),
    doc=contract.ACTION,
)
@hint("Return DriveDistance.Result(driven=driven, reason=''), with driven from the odometry.")
@hint("driven is the distance from the start to the newest position, not the sum of the steps.")
@hint("Create the publisher with a plain 10: self.create_publisher(Twist, 'cmd_vel', 10).")
@hint("A goal is reached when driven >= goal.distance, even if the last progress is less than a centimetre.")
def test_drive_result(placed_driver: Driver, draw: random.Random) -> None:
    """The result holds the distance that the robot drove, and its reason is empty when the goal is reached."""
    x, y = placed_driver.x, placed_driver.y
    goal = placed_driver.start(draw.uniform(1.4, 1.8), 0.5)  # 10 % of it is more than the tolerance
    placed_driver.roll(goal, LONG_SECONDS, until=lambda: math.dist((x, y), (placed_driver.x, placed_driver.y)) > 0.6)
    peak, push_time = math.dist((x, y), (placed_driver.x, placed_driver.y)), placed_driver.seconds
    placed_driver.shift(-PUSH)
    placed_driver.finish(goal, LONG_SECONDS, f"With a robot that is pushed back by {PUSH} m on the way")
    driven = math.dist((x, y), (placed_driver.x, placed_driver.y))
    message = f"In the result, driven is {goal.result.driven:.2f} m, but the robot drove {driven:.2f} m."
    expect(abs(goal.result.driven - driven) <= 0.1, message)
    reported_distances = [
        item.message.driven for item in goal.feedback if push_time < item.seconds <= push_time + FEEDBACK_SECONDS
    ]
    x, y = placed_driver.x, placed_driver.y
    goal = placed_driver.start(1.0, 0.5)
    placed_driver.roll(goal, LONG_SECONDS, until=lambda: math.dist((x, y), (placed_driver.x, placed_driver.y)) > 0.5)
    placed_driver.shift(4 * PUSH)
    placed_driver.finish(goal, LONG_SECONDS, f"With a robot that is pushed on by {4 * PUSH:g} m on a drive of 1 m")
    driven = math.dist((x, y), (placed_driver.x, placed_driver.y))
    reported = goal.result.driven
    message = f"A robot was pushed beyond a goal of 1 m, to {driven:.2f} m: driven in the result is {reported:.2f} m."
    expect(abs(reported - driven) <= 0.1, message, fraction=0.5)
    expect(goal.result.reason == "", f"The goal was reached, but the reason is {goal.result.reason!r}.", fraction=0.5)
    end_time = placed_driver.seconds
    placed_driver.run(0.5)
    commands = placed_driver.messages(COMMANDS, since=end_time)
    message = f"In the 0.5 s after the goal, {len(commands)} more commands were published on cmd_vel."
    expect(not commands, message, fraction=0.5)
    for peer in placed_driver.node.get_publishers_info_by_topic(COMMANDS):
        qos = peer.qos_profile
        is_default_qos = (qos.reliability, qos.durability) == (ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE)
        expect(is_default_qos, "cmd_vel does not have the quality of service of a plain 10.", fraction=0.5)
    expect_volatile(placed_driver.node, ODOMETRY)
    if placed_driver.time == LOCKSTEP:  # in real time, a busy machine may cause a second without progress
        expect_exact_arrival(placed_driver)
    if reported_distances and placed_driver.time == LOCKSTEP:  # in real time, it may have made up for the push
        least = min(reported_distances)
        message = f"After a push from {peak:.2f} m back to {peak - PUSH:.2f} m, the feedback still had {least:.2f} m."
        expect(least <= peak - PUSH / 2, message, fraction=0.75)


@check(points=2, covers=("drives", "driven"), needs=SERVER_CHECK, after=MOTION_CHECK, doc=contract.ACTION)
@hint("goal_handle.publish_feedback(DriveDistance.Feedback(driven=..., remaining=...)) in each pass of the loop.")
def test_drive_feedback(placed_driver: Driver, draw: random.Random) -> None:
    """Ten times a second, it publishes a command and feedback: driven grows, and remaining is the distance left."""
    distance = draw.uniform(0.7, 0.8)
    goal = placed_driver.start(distance, 0.5)
    placed_driver.finish(goal, LONG_SECONDS, f"With {distance:.2f} m to drive")
    feedback = [received.message for received in goal.feedback]
    expect(len(feedback) >= 4, f"It sent {len(feedback)} feedback messages on the way, instead of about ten a second.")
    for item in feedback:
        message = f"driven was {item.driven:.2f} m and remaining was {item.remaining:.2f} m in a feedback message."
        adds_up = is_remaining(distance, item.driven, item.remaining, SLACK)
        expect(adds_up, f"With {distance:.2f} m to drive, {message}")
    driven_distances = [item.driven for item in feedback]
    grows = driven_distances == sorted(driven_distances) and driven_distances[-1] > driven_distances[0] >= 0.0
    expect(grows, "In the feedback, driven did not keep growing from 0.")
    for label, messages in (("feedback", goal.feedback), ("a command", placed_driver.commands())):
        is_paced = message_period.is_paced(messages, contract.PERIOD, placed_driver.time)
        pace = message_period.describe_pace(messages)
        expect(is_paced, f"It published {label} {pace}, instead of every {contract.PERIOD} s.", fraction=0.5)
    placed_driver.is_stuck = True
    goal = placed_driver.start(distance, 0.5)
    placed_driver.roll(goal, HOLD_SECONDS)
    placed_driver.abandon(goal)
    count = sum(received.message.driven < SLACK for received in goal.feedback)
    expected = HOLD_SECONDS / contract.PERIOD
    message = f"While the robot was held for {HOLD_SECONDS} s, it sent {count} feedback messages, not {expected:.0f}."
    expect(count >= expected / 2, message, fraction=0.5)


@check(points=2, covers=("rejects", "busy"), needs=SERVER_CHECK, doc=contract.ACTION)
@hint("accept, which is the goal_callback, returns GoalResponse.ACCEPT or GoalResponse.REJECT.")
@hint("0.0 < goal.distance <= MAX_DISTANCE is false for nan, too.")
def test_drive_rejects(free_driver: Driver, draw: random.Random) -> None:
    """A goal whose distance or speed is out of range is rejected, and a valid goal after it is accepted."""

    def judge(case: tuple[float, float]) -> None:
        distance, speed = case
        goal = free_driver.send(distance, speed)
        if goal.accepted:
            free_driver.abandon(goal)
        message = f"A goal of {distance:.7g} m at {speed:.7g} m/s was accepted."
        expect(not goal.accepted, message, fraction=0.25 if distance == PLAIN_DISTANCE else 0.4)

    for case in INVALID_ALONE:
        judge(case)
    expect_each(INVALID_GOALS, judge, draw, count=12 if free_driver.time == LOCKSTEP else 8)
    valid_goal = free_driver.send(1.0, 0.2)
    if valid_goal.accepted:
        free_driver.abandon(valid_goal)
    message = "After rejected goals, a valid goal was rejected, too: a rejected goal must not keep self.busy."
    expect(valid_goal.accepted is True, message, fraction=0.5)


@check(
    points=1, covers=("rejects", "drives", "no-odometry"), needs=SERVER_CHECK, after=MOTION_CHECK, doc=contract.ACTION
)
@hint("Compare with <=: 5.0 m and 0.5 m/s can be driven.", "speed has a default: a goal without a speed is valid.")
def test_drive_limits(placed_driver: Driver, draw: random.Random) -> None:
    """Goals with the largest distance, the largest speed and the default speed are accepted and driven."""

    def judge(case: tuple[float, float | None]) -> None:
        distance, speed = case
        goal = placed_driver.start(distance, speed)
        commands = placed_driver.roll(goal, 0.4)
        placed_driver.abandon(goal)
        expected = 0.2 if speed is None else speed
        behaviour = f"the robot was told {_describe(commands[0])}" if commands else "no command was published"
        is_correct = bool(commands) and drives_straight(commands[0], expected)
        message = f"With a goal of {distance:.7g} m at {expected:.7g} m/s, {behaviour}."
        expect(is_correct, message, fraction=0.5 if commands else 0.0)

    for case in ((MAX_DISTANCE, None), (0.5, MAX_SPEED)):
        judge(case)
    expect_each(VALID_GOALS, judge, draw, count=2)
    placed_driver.restart()  # so that no earlier goal affects the next
    placed_driver.run(SILENCE)
    goal = placed_driver.send(MAX_DISTANCE)
    if goal.accepted:
        placed_driver.abandon(goal)
    message = f"{SILENCE:.0f} s after the last odometry, a goal was rejected, although the position is known."
    expect(goal.accepted is True, message, fraction=0.5)


def drives_straight(command: Twist, speed: float) -> bool:
    """Return whether a command drives straight on at a speed."""
    return bool(abs(command.linear.x - speed) <= SLACK and abs(command.angular.z) <= SLACK)


def _describe(command: Twist) -> str:
    return f"to drive at {command.linear.x:.2f} m/s and to turn at {command.angular.z:.2f} rad/s"
