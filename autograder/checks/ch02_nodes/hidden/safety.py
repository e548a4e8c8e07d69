"""Safety: a robot that knows nothing does not move."""

from __future__ import annotations

import random

from autograder.checks import group, hint
from autograder.checks.ch02_nodes.support import contract
from autograder.checks.ch02_nodes.support.robot import Robot, expect_forward, expect_stop
from autograder.checks.ch02_nodes.support.scans import scan

check = group("safety")
MARGIN = 0.15  # s beyond the time-out that a timer at 10 Hz may need


@check(points=2, holds=("no-scan", "cmd-vel"), depends=("publishes_cmd_vel",))
@hint("obstacle_detected = False at the start means: drive before anything was seen.")
@hint("Start with last_scan = None, and let None mean stop.")
def test_stops_before_first_scan(fresh_robot: Robot) -> None:
    """It stands still, and says so on cmd_vel, until the first scan has come."""
    expect_stop(fresh_robot.left_alone(1.5), "Before the first scan")


@check(points=3, holds=("stale", "ros-time"), depends=("forward_when_clear",))
@hint("Remember when the last scan came, by self.get_clock().now().")
@hint("In control_loop, compare now with that time: older than 0.5 s means stop.")
def test_stops_when_stale(robot: Robot, draw: random.Random) -> None:
    """It stands still when the newest scan is older than 0.5 s: the lidar has died."""
    distance = draw.uniform(1.5, 3.0)
    expect_forward(robot.see(scan(fill=distance)), f"With {distance:.2f} m of free space all around")
    began = robot.seconds
    robot.left_alone(3.0)
    late = robot.messages("/cmd_vel", since=began + contract.STALE_AFTER + MARGIN)
    expect_stop(late, f"More than {contract.STALE_AFTER} s after the last scan")


@check(points=1, holds=("stale", "clear"), depends=("stops_when_stale",))
@hint("Keep looking at the age of the newest scan; a stop is no state to be stuck in.")
def test_recovers(robot: Robot, draw: random.Random) -> None:
    """It drives again when scans come again."""
    distance = draw.uniform(1.5, 3.0)
    robot.left_alone(2.0)
    expect_forward(robot.see(scan(fill=distance)), "When scans come again after a break of 2 s")
