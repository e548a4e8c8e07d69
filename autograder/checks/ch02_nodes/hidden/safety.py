"""Checks of safety: a robot without a fresh scan does not move."""

from __future__ import annotations

import random
import statistics

import pytest
from sensor_msgs.msg import LaserScan

from autograder.checking import LOCKSTEP, SCAN_SECONDS, Workspace, expect, group, hint
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.robot import (
    SETTLED,
    Reactions,
    Robot,
    expect_stop,
    is_stop,
)
from autograder.checks.ch02_nodes.support.scans import Part, scan

check = group("safety")
TOPIC_CHECKS = ("subscribes_scan", "publishes_cmd_vel")
MARGIN = 0.02  # s before and after the time-out: two short steps; a time-out that is 10 % too long is detected
# In real time, the time-out is somewhere between the last command that drives and the first that stops. The median of
# many trials is accurate to a hundredth of a second.
TRIALS = 12
REAL_MARGIN = 0.04  # s; small enough to detect a time-out that is 10 % too long
STOP_SECONDS = 0.25  # s after the time-out within which the first command that stops must be published
STAMP_AGE = 2.0  # s: the age of a scan's stamp, which the robot must ignore
STEP = 0.01  # s: the length of a step where the time of each command matters
# How fast the machine's clocks run, relative to ROS time, for a robot that must not use them.
SLOW, FAST = 0.25, 8.0


@check(points=2, covers=("no-scan", "cmd-vel"), needs=("publishes_cmd_vel",))
@hint("With obstacle_detected = False at the start, the robot drives before it has seen anything.")
@hint("Start with last_scan = None, and let None mean stop.")
def test_stops_before_first_scan(fresh_robot: Robot, request: pytest.FixtureRequest) -> None:
    """Until the first scan arrives, it publishes zero velocity on cmd_vel."""
    expect_stop(fresh_robot.leave_alone(1.5), "Before the first scan")
    problem = request.getfixturevalue("two_nodes").sharing_problem()
    expect(not problem, problem, fraction=0.75)


@check(points=3, covers=("stale", "ros-time"), needs=TOPIC_CHECKS, after=("forward_when_clear",))
@hint("Remember the time at which the last scan arrived: self.get_clock().now().")
@hint("In control_loop, compare that time with now. If the scan is older than 0.5 s, stop.")
def test_stops_when_stale(workspace: Workspace, robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It stands still when the newest scan arrived more than 0.5 s of ROS time ago."""
    distance = draw.uniform(1.5, 3.0)
    reactions.expect_forward(robot.see(scan(fill=distance)), f"With {distance:.2f} m of free space all around")
    if robot.time != LOCKSTEP:
        _expect_timeout(robot, reactions, scan(fill=distance))
        return
    fresh_until, stale_from = contract.STALE_AFTER - MARGIN, contract.STALE_AFTER + MARGIN
    arrival = _show_before_command(robot, scan(fill=distance), fresh_until - 0.01)
    _run_in_short_steps(robot, fresh_until)
    commands = robot.messages("/cmd_vel", since=arrival + SETTLED, until=arrival + fresh_until)
    reactions.expect_forward(commands, f"Until {fresh_until:.2f} s after the last scan")
    robot.see(scan(fill=distance), 0.5)
    arrival = _show_before_command(robot, scan(fill=distance), stale_from + 0.01)
    _run_in_short_steps(robot, 2.0)
    expect_stop(
        robot.messages("/cmd_vel", since=arrival + stale_from), f"From {stale_from:.2f} s after the last scan on"
    )
    _expect_ros_time(workspace, reactions, scan(fill=distance))


@check(points=1, covers=("stale", "clear", "ros-time"), needs=TOPIC_CHECKS, after=("stops_when_stale",))
@hint("Check the age of the newest scan each time. A robot that has stopped must be able to drive again.")
def test_recovers(robot: Robot, reactions: Reactions, draw: random.Random) -> None:
    """It drives again when scans resume."""
    distance = draw.uniform(1.5, 3.0)
    robot.see(scan(Part(-10.0, 10.0, 0.5)), 0.5)
    robot.leave_alone(1.0)
    blind_commands = robot.leave_alone(1.0)
    reactions.expect_forward(robot.see(scan(fill=distance)), "When scans resume after a break of 2 s")
    expect_stop(blind_commands, "In the last second of a break of 2 s that began in front of a wall", fraction=0.5)
    for age, stamp_time in ((STAMP_AGE, "ago"), (-STAMP_AGE, "in the future")):
        commands = robot.see(scan(fill=distance), age=age)
        situation = f"With scans that arrive now but are stamped {STAMP_AGE:g} s {stamp_time}"
        reactions.expect_forward(commands, situation, fraction=0.5)


def _expect_timeout(robot: Robot, reactions: Reactions, message: LaserScan) -> None:
    """Fail the check unless the median of a robot's time-outs in real time is correct."""
    timeouts = []
    for trial in range(TRIALS):
        robot.see(message, 2 * SCAN_SECONDS)
        # In each trial, the robot's timer fires at a different age of the scan.
        robot.run(SCAN_SECONDS * trial / TRIALS)
        arrival = robot.seconds
        robot.show(message, contract.STALE_AFTER + STOP_SECONDS)
        commands = robot.messages("/cmd_vel", since=arrival)
        drive_times = [received.seconds - arrival for received in commands if reactions.drives([received])]
        stop_times = [received.seconds - arrival for received in commands if is_stop(received)]
        expect(bool(drive_times), "In the first half second after a scan that shows a clear way, it did not drive.")
        expect(bool(stop_times), f"{contract.STALE_AFTER + STOP_SECONDS:g} s after the last scan, it had not stopped.")
        timeouts.append((drive_times[-1] + stop_times[0]) / 2)
    timeout = statistics.median(timeouts)
    is_correct = abs(timeout - contract.STALE_AFTER) <= REAL_MARGIN
    expect(is_correct, f"It stopped {timeout:.2f} s after the last scan, instead of after {contract.STALE_AFTER:g} s.")


def _expect_ros_time(workspace: Workspace, reactions: Reactions, message: LaserScan) -> None:
    """Fail the check if the age of a scan depends on a clock other than ROS time."""
    with Robot(workspace, clock_rate=SLOW) as robot:
        robot.see(message)
        robot.run(contract.STALE_AFTER + MARGIN)
        blind_commands = robot.leave_alone(contract.STALE_AFTER)
        expect_stop(
            blind_commands,
            f"When ROS time runs {1 / SLOW:g} times as fast as the machine's clocks and no scan arrives",
        )
    with Robot(workspace, clock_rate=FAST) as robot:
        commands = robot.see(message)
        situation = f"When the machine's clocks run {FAST:g} times as fast as ROS time and the way is clear"
        reactions.expect_forward(commands, situation, fraction=0.5)


def _show_before_command(robot: Robot, message: LaserScan, age: float) -> float:
    """Publish a scan so that it is `age` seconds old when a command is published; return when the scan arrived."""
    _run_in_short_steps(robot, SCAN_SECONDS)
    commands = robot.messages("/cmd_vel")
    expect(bool(commands), "No command was published on cmd_vel.")
    last_command_time = commands[-1].seconds
    _run_in_short_steps(robot, (last_command_time - age - STEP - robot.seconds) % SCAN_SECONDS)
    robot.show(message, STEP)
    return robot.seconds


def _run_in_short_steps(robot: Robot, seconds: float) -> None:
    """Run in short steps, so that the time of each command is known."""
    for _ in range(round(seconds / STEP)):
        robot.run(STEP)
