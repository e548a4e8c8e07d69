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
FLOOD_SECONDS = 20.0  # s in front of a wall, during which the warnings are counted
QUEUE_DEPTH = 10  # how many statuses the subscription's queue holds
RATE_SECONDS = 4.0  # s in which 40 commands should be published
MAX_RATE, MAX_REAL_RATE = 1.0, 1.1  # warnings a second; more in real time, where lines may be late
LONG_SECONDS = 9.0  # s in front of a wall: long enough that one warning is missing if it warns every 1.8 s
ALTERNATE_SECONDS, ALTERNATIONS = 0.2, 15  # s with an obstacle, and then without one; how many times
# Obstacles that are shown in turn. If a node throttles two warnings separately, it logs two of them within 1.2 s,
# whichever obstacles each is for.
OBSTACLES = (Part(10.0, 20.0, 0.9), Part(-5.0, 5.0, -math.inf), Part(-20.0, -10.0, 0.3))
UNSEEN_SECONDS = 3.0  # s without a scan
# A clear way between things that do not count ahead of a robot, beside it or behind it.
CLEAR_PARTS = (
    Part(60.0, 110.0, 0.5),
    Part(150.0, 180.0, -math.inf),
    Part(4.0, 8.0, math.nan),
    Part(-8.0, -4.0, 0.0),
)
_ENTRY_START = re.compile(r"^(?=\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] )", re.MULTILINE)  # where a log entry begins


@check(points=2, covers="cmd-vel", needs=("publishes_cmd_vel",))
@hint("create_timer(0.1, self.control_loop) calls control_loop ten times a second.")
@hint("Publish in the timer's callback and nowhere else, once each time.")
def test_ten_hertz(robot: Robot) -> None:
    """It publishes ten commands a second at a steady pace, with and without scans."""
    for situation, scan_message, fraction in (
        ("With scans", scan(), 0.0),
        ("In front of a wall", scan(JUST_AHEAD), 0.75),
        ("Without scans", None, 0.0),
    ):
        start = robot.seconds
        if scan_message is None:
            robot.leave_alone(RATE_SECONDS)
        else:
            robot.see(scan_message, RATE_SECONDS)
        commands = robot.messages("/cmd_vel", since=start)
        pace = message_period.describe_pace(commands)
        message = f"{situation}, it published a command {pace}, instead of every {PERIOD} s."
        expect(message_period.is_paced(commands, PERIOD, robot.time), message, fraction=fraction)


@check(points=1, covers="warns", needs=("subscribes_scan",))
@hint("A warning for every scan adds 10 lines a second to the log. Nobody can read them.")
@hint("self.get_logger().warning(..., throttle_duration_sec=1.0)")
def test_no_flood(robot: Robot) -> None:
    """It warns at most once a second, even if the obstacle goes and comes back or the robot is blind meanwhile."""
    start, warnings_before = robot.seconds, len(_log_entries(robot, "WARN"))
    robot.see(scan(JUST_AHEAD), FLOOD_SECONDS)
    _expect_few_warnings(robot, start, warnings_before, f"Blocked for {FLOOD_SECONDS:.0f} s,")
    start, warnings_before = robot.seconds, len(_log_entries(robot, "WARN"))
    for number in range(ALTERNATIONS):
        robot.see(scan(OBSTACLES[number % len(OBSTACLES)]), ALTERNATE_SECONDS)
        robot.see(scan(), ALTERNATE_SECONDS)
    seconds = robot.seconds - start
    situation = f"Blocked {ALTERNATIONS} times in {seconds:.0f} s, by something far, near or too near to measure,"
    _expect_few_warnings(robot, start, warnings_before, situation, fraction=0.5)
    start, warnings_before = robot.seconds, len(_log_entries(robot, "WARN"))
    for _ in range(ALTERNATIONS):
        robot.see(scan(JUST_AHEAD), ALTERNATE_SECONDS)
        robot.see(scan(fill=math.nan), ALTERNATE_SECONDS)
    robot.leave_alone(UNSEEN_SECONDS)
    situation = f"Blocked and blind {ALTERNATIONS} times in turn, then without scans for {UNSEEN_SECONDS:.0f} s,"
    _expect_few_warnings(robot, start, warnings_before, situation, fraction=0.5)


@check(points=1, covers="warns", needs=("subscribes_scan",), after=("turns_when_blocked", "minus_inf"))
@hint("A warning has its own level: self.get_logger().warning(...), in the branch that turns.")
@hint("It must warn repeatedly while it is blocked, not once for each obstacle.")
def test_warns(fresh_robot: Robot, reactions: Reactions) -> None:
    """It warns once a second whenever something is in the way, and never while the way is clear."""
    start = fresh_robot.seconds
    fresh_robot.leave_alone(UNSEEN_SECONDS)
    _expect_few_warnings(fresh_robot, start, 0, "Before the first scan,", fraction=0.5)
    for reading, seconds, suffix in (
        (JUST_AHEAD.value, BLOCKED_SECONDS, ""),
        (JUST_AHEAD.value, BLOCKED_SECONDS, " a second time"),
        (-math.inf, LONG_SECONDS, ", by something too near to measure"),
    ):
        warnings_before = len(_log_entries(fresh_robot, "WARN"))
        commands = fresh_robot.see(scan(Part(-10.0, 10.0, reading)), seconds)
        if math.isinf(reading) and not reactions.turns(commands):
            return  # the robot does not react to this reading, which `minus_inf` reports
        has_enough = _wait_for_log(fresh_robot, "WARN", more_than=warnings_before + int(seconds / SILENT_SECONDS) - 1)
        warnings = len(_log_entries(fresh_robot, "WARN")) - warnings_before
        message = f"Blocked for {seconds:.0f} s{suffix}, it logged {warnings} warnings, instead of one a second."
        expect(has_enough, message, fraction=0.5 if warnings >= MIN_WARNINGS else 0.0)
        fresh_robot.see(scan(), SETTLED)
        warnings_before = len(_log_entries(fresh_robot, "WARN"))
        fresh_robot.see(scan(), 2.0)
        expect(
            len(_log_entries(fresh_robot, "WARN")) == warnings_before, "It logged a warning while the way was clear."
        )
    commands = fresh_robot.see(scan(*CLEAR_PARTS, fill=math.inf), 2.0)
    has_needless_warning = len(_log_entries(fresh_robot, "WARN")) > warnings_before
    expect(
        not has_needless_warning or not reactions.drives(commands),  # other checks test whether it drives
        "It drove on past something beside it, invalid readings and phantoms, but logged a warning.",
        fraction=0.5,
    )


@check(points=1, covers=("logs-status", "status"), needs=("subscribes_status",))
@hint("self.get_logger().info(msg.data), in status_callback.")
def test_logs_status(robot: Robot, draw: random.Random) -> None:
    """The text of each status appears in its log, at level info."""
    status_text = f"battery {draw.randrange(10**6)}"
    for count, suffix in enumerate(("", " again")):
        robot.publish("/status", String(data=status_text))
        robot.run(0.3)
        is_logged = _wait_for_log(robot, "INFO", status_text, more_than=count)
        expect(is_logged, f"The status {status_text!r} was published{suffix}, but it was not logged at level info.")
    burst = [f"{status_text}, number {number}." for number in range(QUEUE_DEPTH)]
    for text in burst:
        robot.publish("/status", String(data=text))
    robot.run(0.3)

    def count_logged() -> int:
        return sum(bool(_log_entries(robot, "INFO", text)) for text in burst)

    robot.wait_for(lambda: count_logged() == QUEUE_DEPTH, WRITTEN_SECONDS)
    count = count_logged()
    message = (
        f"Of {QUEUE_DEPTH} statuses that were published at once, it logged {count}. "
        f"A queue of {QUEUE_DEPTH} holds all of them."
    )
    expect(count == QUEUE_DEPTH, message, fraction=0.5)


def _expect_few_warnings(
    robot: Robot, start: float, warnings_before: int, situation: str, *, fraction: float = 0.0
) -> None:
    """Fail the check if the node has logged more than one warning a second since `start`, not counting earlier ones."""
    seconds, warnings = robot.seconds - start, len(_log_entries(robot, "WARN")) - warnings_before
    limit, real_limit = (round(rate * seconds) + 1 for rate in (MAX_RATE, MAX_REAL_RATE))
    expect(
        warnings <= (limit if robot.time == LOCKSTEP else real_limit),
        f"{situation} it logged {warnings} warnings: it should never warn twice within 1 s.",
        fraction=0.5 if warnings <= real_limit else fraction,
    )


def _wait_for_log(robot: Robot, level: str, text: str = "", *, more_than: int = 0) -> bool:
    """Wait for more than `more_than` log entries with a text at this level; return whether they were logged."""
    return robot.wait_for(lambda: len(_log_entries(robot, level, text)) > more_than, WRITTEN_SECONDS)


def _log_entries(robot: Robot, level: str, text: str = "") -> list[str]:
    """Return the log entries with a text at this level; an entry may have several lines."""
    entries = _ENTRY_START.split(robot.output)
    return [entry for entry in entries if entry.startswith(f"[{level}]") and text in entry]
