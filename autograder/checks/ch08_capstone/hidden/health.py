"""Step 2, status_monitor: its reports on the other nodes, and when they come."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import Twist

from autograder.checking import LOCKSTEP, SCAN_SECONDS, ReceivedMessage, expect, group, hint
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.hidden.reports import describe_report, repeat_until_phase
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    DEGRADED,
    FAILED,
    MONITOR,
    OK,
    PARAMETERS,
    PROGRAMS,
    REPORT_DEADLINE,
    WATCHED_TOPICS,
)
from autograder.checks.ch08_capstone.support.system import SETTLED, SharedSystem, System

check = group("step_2")
LIDAR_TOPICS = {"scan", "clearance"}  # silent if the lidar is dead
SILENCE_TIMEOUT = PARAMETERS[MONITOR]["silence_timeout"].default
MARGIN = 0.1  # s
REAL_MARGIN = 0.25  # s, in real time
# s: ages of the stamps of a lidar whose clock is behind or ahead. EARLY is further ahead than SILENCE_TIMEOUT.
LATE, EARLY = 5.0, -2.0
MAX_REPORT_AGE = 0.2  # s between a report's stamp and its arrival, enough for a busy machine


@check(
    points=3,
    covers=("monitor", "level", "silent", "silent-field", "health-header"),
    needs=("build",),
    after=("processor", "controller", "monitor", "readings"),
    doc=contract.NODES_DOC,
)
@hint("A topic that was never heard is silent, too, from the first report on: start with None for each.")
@hint("What counts is when a message arrives, by self.get_clock().now(), not what its stamp says.")
@hint("FAILED if any topic is silent; else DEGRADED if the newest clearance is not valid; else OK.")
def test_health_levels(system: System, lone_monitor: SharedSystem) -> None:
    """Twice a second it reports: FAILED before anything was seen, OK when all is well, DEGRADED when blind."""
    first = system.before_first_scan.reports
    _expect_reports(first[-1:], FAILED, LIDAR_TOPICS, "Before the first scan")
    # The controller may start later than the monitor, so cmd_vel may be silent at first, too.
    early = next((r.message for r in first if r.message.level != FAILED or not _silent_topics(r) >= LIDAR_TOPICS), None)
    description = "" if early is None else describe_report(early)
    expect(
        early is None,
        f"Before the first scan, an early report said {description}: nothing was heard yet.",
        fraction=0.5,
    )
    start = system.seconds
    reports = system.publish_scans(OPEN, 3.0).reports
    _expect_reports(reports, OK, set(), "With scans for 3 s", fraction=0.25)
    rate = system.harness.rate("/health", start)
    expect(1.6 <= rate <= 2.4, f"It published {rate:.1f} reports a second, instead of 2.", fraction=0.5)
    _expect_report_stamp(system, reports[-1])
    blind_reports = system.publish_scans(scan(Part(-35.0, 35.0, math.nan)), 2.0).reports
    _expect_reports(blind_reports, DEGRADED, set(), "With nan from every beam ahead", fraction=0.5)
    dead_reports = system.wait(REPORT_DEADLINE).reports[-1:]
    _expect_reports(
        dead_reports, FAILED, LIDAR_TOPICS, f"{REPORT_DEADLINE:.0f} s after the last scan, a blind one", fraction=0.5
    )
    _expect_reports(system.publish_scans(OPEN, 1.0).reports, OK, set(), "When it sees again", fraction=0.5)
    late_reports = system.publish_scans(OPEN, 1.5, age=LATE).reports
    _expect_reports(late_reports, OK, set(), f"With scans that arrive, stamped {LATE:.0f} s earlier", fraction=0.5)
    monitor = lone_monitor.get(MONITOR)
    reports_without_controller = _send_all(monitor, ("scan", "clearance"), 1.5)
    _expect_reports(
        reports_without_controller, FAILED, {"cmd_vel"}, "With scans, and no controller that runs", fraction=0.5
    )
    half_blind_reports = _send_all(monitor, WATCHED_TOPICS, 1.0, left=math.nan)[-1:]
    situation = "With a clearance that is not valid, as it has nan on the left alone"
    _expect_reports(half_blind_reports, DEGRADED, set(), situation, fraction=0.85)


@check(
    points=3, covers=("silent", "silent-field", "monitor", "health-header"), needs=("build",), after=("health_levels",)
)
@hint("Remember when each topic was last heard, by self.get_clock().now(), and compare in the timer's callback.")
@hint("A callback of the dead topic cannot tell that it is dead: only a timer can.")
def test_dead_sensor(system: System, slow_system: SharedSystem, lone_monitor: SharedSystem) -> None:
    """Within 2 s of a lidar's death health is FAILED and names what is silent; within 2 s of its return it is OK."""
    system.publish_scans(OPEN, 2.0)
    start = system.seconds
    reports = system.wait(4.0).reports
    first_failed = next((r for r in reports if r.message.level == FAILED), None)
    delay = "never" if first_failed is None else f"only {first_failed.seconds - start:.1f} s after"
    expect(
        first_failed is not None and first_failed.seconds - start <= REPORT_DEADLINE,
        f"The lidar died, and health was FAILED {delay}.",
    )
    early_reports = [r for r in reports if r.message.level == FAILED and r.seconds - start < SILENCE_TIMEOUT - MARGIN]
    message = f"Health was FAILED less than {SILENCE_TIMEOUT:.0f} s after the last scan: that is no silence yet."
    expect(not early_reports, message, fraction=0.5)
    is_paced = message_period.is_paced(reports, 0.5, system.harness.time)
    expect(
        is_paced,
        f"It published a report {message_period.describe_pace(reports)}, instead of two a second.",
        fraction=0.5,
    )
    later_reports = [r for r in reports if r.seconds - start > REPORT_DEADLINE]
    _expect_reports(later_reports, FAILED, LIDAR_TOPICS, "2 to 4 s after the last scan", fraction=0.5)
    system.publish_scans(OPEN, REPORT_DEADLINE)
    newest_reports = system.harness.messages("/health")[-1:]
    _expect_reports(newest_reports, OK, set(), f"{REPORT_DEADLINE:.0f} s after the lidar came back", fraction=0.75)
    system.publish_scans(OPEN, 1.0, age=EARLY)
    dead_reports = system.wait(REPORT_DEADLINE).reports[-1:]
    situation = f"{REPORT_DEADLINE:.0f} s after the last scan, whose stamp was {-EARLY:.0f} s ahead of the clock,"
    _expect_reports(dead_reports, FAILED, LIDAR_TOPICS, situation, fraction=0.75)
    if system.harness.time == LOCKSTEP:  # in real time, the clocks of the machine cannot be slowed
        _expect_ros_time(slow_system.get(*PROGRAMS))
    for topic in ("cmd_vel", "clearance"):
        _expect_silence_reported(lone_monitor.get(MONITOR), topic)


def _expect_ros_time(system: System) -> None:
    """Fail the check if the monitor measures silence by another clock than that of ROS."""
    system.publish_scans(OPEN, 2.0)
    reports = system.wait(REPORT_DEADLINE).reports
    _expect_reports(
        reports[-1:], FAILED, LIDAR_TOPICS, f"{REPORT_DEADLINE:.0f} s of ROS time after the last scan", fraction=0.5
    )
    _expect_report_stamp(system, reports[-1])


def _expect_silence_reported(system: System, topic: str) -> None:
    """Fail the check unless a topic, and no other, is reported as silent after the time-out."""
    _send_all(system, WATCHED_TOPICS, 0.5)
    repeat_until_phase(system, lambda: _send_all(system, WATCHED_TOPICS, SCAN_SECONDS))
    margin = MARGIN if system.harness.time == LOCKSTEP else REAL_MARGIN
    last_message = system.seconds
    _send_all(system, [other for other in WATCHED_TOPICS if other != topic], REPORT_DEADLINE)
    reports = system.messages(last_message + SILENCE_TIMEOUT + margin).reports
    situation = f"More than {SILENCE_TIMEOUT:.0f} s after the last message on {topic}, while the others went on"
    _expect_reports(reports, FAILED, {topic}, situation, fraction=0.85)


def _send_all(system: System, topics: Sequence[str], seconds: float, **distances: float) -> Sequence[ReceivedMessage]:
    """Send the monitor a message on each topic ten times a second; return its reports since it had time to react.

    The clearance has +inf in all directions that `distances` does not contain, and is valid unless one of them is nan.
    """
    start, is_valid = system.seconds, not any(map(math.isnan, distances.values()))
    default_distances = {"front": math.inf, "left": math.inf, "right": math.inf}
    clearance = system.types.clearance(valid=is_valid, **{**default_distances, **distances})
    messages: dict[str, Any] = {"scan": OPEN, "clearance": clearance, "cmd_vel": Twist()}
    for _ in range(round(seconds / SCAN_SECONDS)):
        for topic in topics:
            system.send(f"/{topic}", messages[topic])
        system.harness.run(SCAN_SECONDS)
    return system.messages(start + SETTLED).reports


def _expect_report_stamp(system: System, report: ReceivedMessage) -> None:
    """Fail the check unless a report's stamp is the ROS time at which it was published."""
    stamp = report.message.header.stamp
    arrival = system.harness.now_ns / 1e9 - (system.seconds - report.seconds)
    age = arrival - (stamp.sec + stamp.nanosec / 1e9)
    expect(stamp.sec != 0, "The stamp of health is 0: it was never set.", fraction=0.5)
    expect(
        abs(age) <= MAX_REPORT_AGE, f"By its stamp, a report of health was {age:.1f} s old when it came.", fraction=0.5
    )


def _expect_reports(
    reports: Sequence[ReceivedMessage], level: int, silent: set[str], situation: str, *, fraction: float = 0.0
) -> None:
    """Fail the check unless there is a report, and each one has this level and these silent topics."""
    expect(bool(reports), f"{situation}, no report came on health.", fraction=fraction)
    expected = f"level {contract.LEVELS[level]}, silent: {', '.join(sorted(silent)) or 'none'}"
    for report in reports:
        expect(
            report.message.level == level and _silent_topics(report) == silent,
            f"{situation}, health said {describe_report(report.message)}; the contract asks {expected}.",
            fraction=fraction,
        )


def _silent_topics(report: ReceivedMessage) -> set[str]:
    """Return the topics that a report lists as silent."""
    return {str(topic).lstrip("/") for topic in report.message.silent}
