"""Safety: a robot that knows nothing does not move."""

from __future__ import annotations

import random
import statistics

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
TALKS = ("subscribes_scan", "publishes_cmd_vel")
MARGIN = 0.02  # s around the time-out, two of the shortest steps: a tenth too much is seen
# Where time is real, a command comes when it comes. Between the last that drives and the first that stops lies the
# time-out, somewhere; the median of many is it, to a hundredth of a second.
TRIALS = 12
REAL_MARGIN = 0.04  # s: a tenth too much is seen there, too
AFTER = 0.25  # s after the time-out: the first command that stops has come
LATE = 2.0  # s: how old a stamp is, of a scan of which only the arrival counts
FINE = 0.01  # s between two looks at the clock
# Of ROS time: how fast the machine's clocks run for a robot that must not look at them.
SLOW, FAST = 0.25, 8.0


@check(points=2, covers=("no-scan", "cmd-vel"), needs=("publishes_cmd_vel",))
@hint("obstacle_detected = False at the start means: drive before anything was seen.")
@hint("Start with last_scan = None, and let None mean stop.")
def test_stops_before_first_scan(fresh_robot: Robot) -> None:
    """It stands still, and says so on cmd_vel, until the first scan has come."""
    expect_stop(fresh_robot.left_alone(1.5), "Before the first scan")


@check(points=3, covers=("stale", "ros-time"), needs=TALKS, after=("forward_when_clear",))
@hint("Remember when the last scan came, by self.get_clock().now().")
@hint("In control_loop, compare now with that time: older than 0.5 s means stop.")
def test_stops_when_stale(workspace: Workspace, robot: Robot, own: Reactions, draw: random.Random) -> None:
    """It stands still when the newest scan is older than 0.5 s of ROS time: the lidar has died."""
    distance = draw.uniform(1.5, 3.0)
    own.expect_forward(robot.see(scan(fill=distance)), f"With {distance:.2f} m of free space all around")
    if robot.time != LOCKSTEP:
        _expect_timeout(robot, own, scan(fill=distance))
        return
    last, first = contract.STALE_AFTER - MARGIN, contract.STALE_AFTER + MARGIN
    came = _show_before_command(robot, scan(fill=distance), last - 0.01)
    _run_finely(robot, last)
    fresh = robot.messages("/cmd_vel", since=came + SETTLED, until=came + last)
    own.expect_forward(fresh, f"{last:.2f} s after the last scan and earlier")
    robot.see(scan(fill=distance), 0.5)
    came = _show_before_command(robot, scan(fill=distance), first + 0.01)
    _run_finely(robot, 2.0)
    expect_stop(robot.messages("/cmd_vel", since=came + first), f"{first:.2f} s after the last scan and later")
    _expect_ros_time(workspace, own, scan(fill=distance))


@check(points=1, covers=("stale", "clear", "ros-time"), needs=TALKS, after=("stops_when_stale",))
@hint("Keep looking at the age of the newest scan; a stop is no state to be stuck in.")
def test_recovers(robot: Robot, own: Reactions, draw: random.Random) -> None:
    """It drives again when scans come again."""
    distance = draw.uniform(1.5, 3.0)
    robot.see(scan(Part(-10.0, 10.0, 0.5)), 0.5)
    robot.left_alone(1.0)
    blind = robot.left_alone(1.0)
    own.expect_forward(robot.see(scan(fill=distance)), "When scans come again after a break of 2 s")
    expect_stop(blind, "In the last second of a break of 2 s, which began in front of a wall", fraction=0.5)
    late = robot.see(scan(fill=distance), late=LATE)
    own.expect_forward(late, f"With scans that arrive now, and whose stamps are {LATE:g} s old", fraction=0.5)


def _expect_timeout(robot: Robot, own: Reactions, shown: LaserScan) -> None:
    """Fail the check unless a robot in real time takes a scan for old when it is, in the median of many times."""
    seen = []
    for number in range(TRIALS):
        robot.see(shown, 2 * SCAN_SECONDS)
        robot.run(SCAN_SECONDS * number / TRIALS)  # so that its timer fires at another age of the scan each time
        came = robot.seconds
        robot.show(shown, contract.STALE_AFTER + AFTER)
        commands = robot.messages("/cmd_vel", since=came)
        driving = [received.seconds - came for received in commands if own.drives([received])]
        stopped = [received.seconds - came for received in commands if is_stop(received)]
        expect(bool(driving), "In the first half second after a scan that shows a clear way, it did not drive.")
        expect(bool(stopped), f"{contract.STALE_AFTER + AFTER:g} s after the last scan, it had not stopped.")
        seen.append((driving[-1] + stopped[0]) / 2)
    timeout = statistics.median(seen)
    right = abs(timeout - contract.STALE_AFTER) <= REAL_MARGIN
    expect(right, f"It stopped {timeout:.2f} s after the last scan, instead of after {contract.STALE_AFTER:g} s.")


def _expect_ros_time(workspace: Workspace, own: Reactions, shown: LaserScan) -> None:
    """Fail the check if the age of a scan depends on another clock than that of ROS."""
    with Robot(workspace, clock_rate=SLOW) as robot:
        robot.see(shown)
        robot.run(contract.STALE_AFTER + MARGIN)
        blind = robot.left_alone(contract.STALE_AFTER)
        expect_stop(blind, f"Where ROS time runs {1 / SLOW:g} times as fast as the machine's clocks, without a scan")
    with Robot(workspace, clock_rate=FAST) as robot:
        seen = robot.see(shown)
        said = f"Where the machine's clocks run {FAST:g} times as fast as ROS time, with a clear way"
        own.expect_forward(seen, said, fraction=0.5)


def _show_before_command(robot: Robot, shown: LaserScan, age: float) -> float:
    """Show a scan so that a command comes when it is `age` seconds old; return when it arrived."""
    _run_finely(robot, SCAN_SECONDS)
    told = robot.messages("/cmd_vel")
    expect(bool(told), "No command came on /cmd_vel.")
    command = told[-1].seconds
    _run_finely(robot, (command - age - FINE - robot.seconds) % SCAN_SECONDS)
    robot.show(shown, FINE)
    return robot.seconds


def _run_finely(robot: Robot, seconds: float) -> None:
    """Let time pass in short steps, so that it is known when each command came."""
    for _ in range(round(seconds / FINE)):
        robot.run(FINE)
