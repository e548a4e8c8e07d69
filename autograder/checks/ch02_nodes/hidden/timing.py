"""Timing: ten commands a second, and a log that stays readable."""

from __future__ import annotations

from autograder.checks import expect, group, hint
from autograder.checks.ch02_nodes.support.robot import Robot
from autograder.checks.ch02_nodes.support.scans import Part, scan

check = group("timing")
SECONDS = 20.0


@check(points=2, depends=("publishes_cmd_vel",))
@hint("create_timer(0.1, self.control_loop) calls control_loop ten times a second.")
@hint("Publish in the timer's callback and nowhere else, once each time.")
def test_ten_hertz(robot: Robot) -> None:
    """It publishes ten commands a second, with scans and without."""
    for situation in ("with scans", "without scans"):
        began = robot.seconds
        if situation == "with scans":
            robot.see(scan(), 2.0)
        else:
            robot.left_alone(2.0)
        rate = robot.rate("/cmd_vel", since=began)
        expect(9.0 <= rate <= 11.0, f"It published {rate:.1f} commands a second {situation}, instead of 10.")


@check(points=2, depends=("subscribes_scan",))
@hint("A warning at every scan is 10 lines a second, and nobody reads them.")
@hint("self.get_logger().warning(..., throttle_duration_sec=1.0)")
def test_no_flood(robot: Robot) -> None:
    """It logs at most about one line a second while it is blocked."""
    before = len(robot.output.splitlines())
    robot.see(scan(Part(-10.0, 10.0, 0.5)), SECONDS)
    lines = len(robot.output.splitlines()) - before
    expect(lines <= 2 * SECONDS, f"Blocked for {SECONDS:.0f} s, it logged {lines} lines.")
