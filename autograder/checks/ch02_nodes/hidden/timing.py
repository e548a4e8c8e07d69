"""Timing: ten commands a second, and a log that says what it should and stays readable."""

from __future__ import annotations

import math
import random
import re

from std_msgs.msg import String

from autograder.checking import LOCKSTEP, expect, group, hint
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.contract import BLOCKED_SECONDS, MIN_WARNINGS, PERIOD, SILENT_SECONDS
from autograder.checks.ch02_nodes.support.robot import SETTLED, WRITTEN_SECONDS, Reactions, Robot
from autograder.checks.ch02_nodes.support.scans import JUST_AHEAD, Part, scan

check = group("timing")
SECONDS = 20.0
QUEUE = 10  # statuses that a plain 10 holds
RATE_SECONDS = 4.0  # in which forty commands come
WARNINGS, REAL_WARNINGS = 1.0, 1.1  # a second, at most; more where time is real and lines are late
LONG_SECONDS = 9.0  # in front of a wall: who warns every 1.8 s has warned once too seldom
ALTERNATE_SECONDS, ALTERNATIONS = 0.2, 15  # s for which something is in the way, and then is not; how often
# What is in the way, in turn. Two throttles, whichever of these each is for, let two warnings through in 1.2 s.
IN_TURN = (Part(10.0, 20.0, 0.9), Part(-5.0, 5.0, -math.inf), Part(-20.0, -10.0, 0.3))
_ENTRY = re.compile(r"^(?=\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] )", re.MULTILINE)  # where one begins in the log


@check(points=2, covers="cmd-vel", needs=("publishes_cmd_vel",))
@hint("create_timer(0.1, self.control_loop) calls control_loop ten times a second.")
@hint("Publish in the timer's callback and nowhere else, once each time.")
def test_ten_hertz(robot: Robot) -> None:
    """It publishes ten commands a second, one after the other, with scans and without."""
    for situation, shown, fraction in (
        ("with scans", scan(), 0.0),
        ("in front of a wall", scan(JUST_AHEAD), 0.75),
        ("without scans", None, 0.0),
    ):
        began = robot.seconds
        if shown is None:
            robot.left_alone(RATE_SECONDS)
        else:
            robot.see(shown, RATE_SECONDS)
        commands = robot.messages("/cmd_vel", since=began)
        said = (
            f"It published a command {message_period.describe_pace(commands)} {situation}, instead of every {PERIOD} s."
        )
        expect(message_period.is_paced(commands, PERIOD, robot.time), said, fraction=fraction)


@check(points=1, covers="warns", needs=("subscribes_scan",))
@hint("A warning at every scan is 10 lines a second, and nobody reads them.")
@hint("self.get_logger().warning(..., throttle_duration_sec=1.0)")
def test_no_flood(robot: Robot) -> None:
    """It warns at most once a second while it is blocked, or blocked again and again."""
    began, warned = robot.seconds, len(_logged(robot, "WARN"))
    robot.see(scan(JUST_AHEAD), SECONDS)
    _expect_few_warnings(robot, began, warned, f"Blocked for {SECONDS:.0f} s,")
    began, warned = robot.seconds, len(_logged(robot, "WARN"))
    for number in range(ALTERNATIONS):
        robot.see(scan(IN_TURN[number % len(IN_TURN)]), ALTERNATE_SECONDS)
        robot.see(scan(), ALTERNATE_SECONDS)
    seconds = robot.seconds - began
    situation = f"With something in the way {ALTERNATIONS} times in {seconds:.0f} s, far, near or too near to measure,"
    _expect_few_warnings(robot, began, warned, situation, fraction=0.5)


@check(points=1, covers="warns", needs=("subscribes_scan",), after=("turns_when_blocked", "minus_inf"))
@hint("A warning has its own level: self.get_logger().warning(...), in the branch that turns.")
@hint("It warns again and again while it is blocked, not once for each obstacle.")
def test_warns(fresh_robot: Robot, own: Reactions) -> None:
    """It warns once a second while something is in the way, each time, and not while the way is clear."""
    for reading, seconds, time in (
        (JUST_AHEAD.value, BLOCKED_SECONDS, ""),
        (JUST_AHEAD.value, BLOCKED_SECONDS, " a second time"),
        (-math.inf, LONG_SECONDS, ", by what is too near to be measured"),
    ):
        before = len(_logged(fresh_robot, "WARN"))
        seen = fresh_robot.see(scan(Part(-10.0, 10.0, reading)), seconds)
        if math.isinf(reading) and not own.turns(seen):
            return  # to this robot nothing is in the way; `minus_inf` says so
        enough = _logs(fresh_robot, "WARN", more_than=before + int(seconds / SILENT_SECONDS) - 1)
        warnings = len(_logged(fresh_robot, "WARN")) - before
        said = f"Blocked for {seconds:.0f} s{time}, it logged {warnings} warnings, not one a second."
        expect(enough, said, fraction=0.5 if warnings >= MIN_WARNINGS else 0.0)
        fresh_robot.see(scan(), SETTLED)
        before = len(_logged(fresh_robot, "WARN"))
        fresh_robot.see(scan(), 2.0)
        expect(len(_logged(fresh_robot, "WARN")) == before, "The way was clear, and it logged a warning.")


@check(points=1, covers=("logs-status", "status"), needs=("subscribes_status",))
@hint("self.get_logger().info(msg.data), in status_callback.")
def test_logs_status(robot: Robot, draw: random.Random) -> None:
    """The text of each status is in its log, at level info."""
    words = f"battery {draw.randrange(10**6)}"
    for count, time in enumerate(("", " again")):
        robot.publish("/status", String(data=words))
        robot.run(0.3)
        logged = _logs(robot, "INFO", words, more_than=count)
        expect(logged, f"The status {words!r} came{time}, and it logged nothing of it at level info.")
    burst = [f"{words}, number {number}." for number in range(QUEUE)]
    for text in burst:
        robot.publish("/status", String(data=text))
    robot.run(0.3)

    def logged_of_burst() -> int:
        return sum(bool(_logged(robot, "INFO", text)) for text in burst)

    robot.wait_for(lambda: logged_of_burst() == QUEUE, WRITTEN_SECONDS)
    count = logged_of_burst()
    said = f"Of {QUEUE} statuses that came at once, it logged {count}: a queue of {QUEUE} holds them all."
    expect(count == QUEUE, said, fraction=0.5)


def _expect_few_warnings(robot: Robot, began: float, before: int, situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check if it logged more than a warning a second since `began`, when there were `before` of them."""
    seconds, warnings = robot.seconds - began, len(_logged(robot, "WARN")) - before
    most, real_most = (round(rate * seconds) + 1 for rate in (WARNINGS, REAL_WARNINGS))
    expect(
        warnings <= (most if robot.time == LOCKSTEP else real_most),
        f"{situation} it logged {warnings} warnings: it should never warn twice within 1 s.",
        fraction=0.5 if warnings <= real_most else fraction,
    )


def _logs(robot: Robot, level: str, words: str = "", *, more_than: int = 0) -> bool:
    """Wait until more entries with these words were logged at this level; return whether that happens."""
    return robot.wait_for(lambda: len(_logged(robot, level, words)) > more_than, WRITTEN_SECONDS)


def _logged(robot: Robot, level: str, words: str = "") -> list[str]:
    """Return the entries with these words that the robot has logged at this level, each of one or more lines."""
    entries = _ENTRY.split(robot.output)
    return [entry for entry in entries if entry.startswith(f"[{level}]") and words in entry]
