"""Checks of timing: ten commands a second, and a log that has the required messages and stays readable."""

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
FLOOD_SECONDS = 20.0  # s in front of a wall, in which the warnings are counted
QUEUE_DEPTH = 10  # how many statuses the subscription's queue holds
RATE_SECONDS = 4.0  # s in which 40 commands should come
MAX_RATE, MAX_REAL_RATE = 1.0, 1.1  # warnings a second; more in real time, where lines may be late
LONG_SECONDS = 9.0  # s in front of a wall: long enough that one warning is missing if they come every 1.8 s
ALTERNATE_SECONDS, ALTERNATIONS = 0.2, 15  # s with an obstacle, and then without one; how many times
# The obstacles, shown in turn. If a node throttles two warnings separately, whichever obstacles each is for, two come
# within 1.2 s.
OBSTACLES = (Part(10.0, 20.0, 0.9), Part(-5.0, 5.0, -math.inf), Part(-20.0, -10.0, 0.3))
_ENTRY_START = re.compile(r"^(?=\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] )", re.MULTILINE)  # where a log entry begins


@check(points=2, covers="cmd-vel", needs=("publishes_cmd_vel",))
@hint("create_timer(0.1, self.control_loop) calls control_loop ten times a second.")
@hint("Publish in the timer's callback and nowhere else, once each time.")
def test_ten_hertz(robot: Robot) -> None:
    """It publishes ten commands a second, one after the other, with scans and without."""
    for situation, message, fraction in (
        ("with scans", scan(), 0.0),
        ("in front of a wall", scan(JUST_AHEAD), 0.75),
        ("without scans", None, 0.0),
    ):
        start = robot.seconds
        if message is None:
            robot.leave_alone(RATE_SECONDS)
        else:
            robot.see(message, RATE_SECONDS)
        commands = robot.messages("/cmd_vel", since=start)
        reason = (
            f"It published a command {message_period.describe_pace(commands)} {situation}, instead of every {PERIOD} s."
        )
        expect(message_period.is_paced(commands, PERIOD, robot.time), reason, fraction=fraction)


@check(points=1, covers="warns", needs=("subscribes_scan",))
@hint("A warning at every scan is 10 lines a second, and nobody reads them.")
@hint("self.get_logger().warning(..., throttle_duration_sec=1.0)")
def test_no_flood(robot: Robot) -> None:
    """It warns at most once a second while it is blocked, or blocked again and again."""
    start, warnings_before = robot.seconds, len(_log_entries(robot, "WARN"))
    robot.see(scan(JUST_AHEAD), FLOOD_SECONDS)
    _expect_few_warnings(robot, start, warnings_before, f"Blocked for {FLOOD_SECONDS:.0f} s,")
    start, warnings_before = robot.seconds, len(_log_entries(robot, "WARN"))
    for number in range(ALTERNATIONS):
        robot.see(scan(OBSTACLES[number % len(OBSTACLES)]), ALTERNATE_SECONDS)
        robot.see(scan(), ALTERNATE_SECONDS)
    seconds = robot.seconds - start
    situation = f"With something in the way {ALTERNATIONS} times in {seconds:.0f} s, far, near or too near to measure,"
    _expect_few_warnings(robot, start, warnings_before, situation, fraction=0.5)


@check(points=1, covers="warns", needs=("subscribes_scan",), after=("turns_when_blocked", "minus_inf"))
@hint("A warning has its own level: self.get_logger().warning(...), in the branch that turns.")
@hint("It warns again and again while it is blocked, not once for each obstacle.")
def test_warns(fresh_robot: Robot, reactions: Reactions) -> None:
    """It warns once a second while something is in the way, each time, and not while the way is clear."""
    for reading, seconds, suffix in (
        (JUST_AHEAD.value, BLOCKED_SECONDS, ""),
        (JUST_AHEAD.value, BLOCKED_SECONDS, " a second time"),
        (-math.inf, LONG_SECONDS, ", by what is too near to be measured"),
    ):
        warnings_before = len(_log_entries(fresh_robot, "WARN"))
        commands = fresh_robot.see(scan(Part(-10.0, 10.0, reading)), seconds)
        if math.isinf(reading) and not reactions.turns(commands):
            return  # the robot does not react to this reading, which `minus_inf` reports
        has_enough = _wait_for_log(fresh_robot, "WARN", more_than=warnings_before + int(seconds / SILENT_SECONDS) - 1)
        warnings = len(_log_entries(fresh_robot, "WARN")) - warnings_before
        message = f"Blocked for {seconds:.0f} s{suffix}, it logged {warnings} warnings, not one a second."
        expect(has_enough, message, fraction=0.5 if warnings >= MIN_WARNINGS else 0.0)
        fresh_robot.see(scan(), SETTLED)
        warnings_before = len(_log_entries(fresh_robot, "WARN"))
        fresh_robot.see(scan(), 2.0)
        expect(len(_log_entries(fresh_robot, "WARN")) == warnings_before, "The way was clear, and it logged a warning.")


@check(points=1, covers=("logs-status", "status"), needs=("subscribes_status",))
@hint("self.get_logger().info(msg.data), in status_callback.")
def test_logs_status(robot: Robot, draw: random.Random) -> None:
    """The text of each status is in its log, at level info."""
    words = f"battery {draw.randrange(10**6)}"
    for count, suffix in enumerate(("", " again")):
        robot.publish("/status", String(data=words))
        robot.run(0.3)
        is_logged = _wait_for_log(robot, "INFO", words, more_than=count)
        expect(is_logged, f"The status {words!r} came{suffix}, and it logged nothing of it at level info.")
    burst = [f"{words}, number {number}." for number in range(QUEUE_DEPTH)]
    for text in burst:
        robot.publish("/status", String(data=text))
    robot.run(0.3)

    def count_logged() -> int:
        return sum(bool(_log_entries(robot, "INFO", text)) for text in burst)

    robot.wait_for(lambda: count_logged() == QUEUE_DEPTH, WRITTEN_SECONDS)
    count = count_logged()
    message = (
        f"Of {QUEUE_DEPTH} statuses that came at once, it logged {count}: a queue of {QUEUE_DEPTH} holds them all."
    )
    expect(count == QUEUE_DEPTH, message, fraction=0.5)


def _expect_few_warnings(robot: Robot, start: float, before: int, situation: str, *, fraction: float = 0.0) -> None:
    """Fail the check if the node logged more than a warning a second since `start`, after `before` earlier ones."""
    seconds, warnings = robot.seconds - start, len(_log_entries(robot, "WARN")) - before
    limit, real_limit = (round(rate * seconds) + 1 for rate in (MAX_RATE, MAX_REAL_RATE))
    expect(
        warnings <= (limit if robot.time == LOCKSTEP else real_limit),
        f"{situation} it logged {warnings} warnings: it should never warn twice within 1 s.",
        fraction=0.5 if warnings <= real_limit else fraction,
    )


def _wait_for_log(robot: Robot, level: str, words: str = "", *, more_than: int = 0) -> bool:
    """Wait for more than `more_than` entries with these words at this level; return whether they were logged."""
    return robot.wait_for(lambda: len(_log_entries(robot, level, words)) > more_than, WRITTEN_SECONDS)


def _log_entries(robot: Robot, level: str, words: str = "") -> list[str]:
    """Return the log entries with these words at this level; an entry may have several lines."""
    entries = _ENTRY_START.split(robot.output)
    return [entry for entry in entries if entry.startswith(f"[{level}]") and words in entry]
