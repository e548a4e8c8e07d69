"""Step 2, status_monitor: its reports on the other nodes, and their times."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from autograder.checking import LOCKSTEP, ReceivedMessage, expect, group, hint
from autograder.checking.drawn_cases import expect_each
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.drawn_reports import (
    ONE_SILENT_TOPIC,
    SCANS_STAMPED_AHEAD,
    describe,
    expect_reports,
    report_text,
    seeing,
    send_all,
    silences,
    silent_topics,
)
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    DEGRADED,
    FAILED,
    MONITOR,
    OK,
    PROGRAMS,
    REPORT_DEADLINE,
    WATCHED_TOPICS,
)
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

check = group("step_2")
LIDAR_TOPICS = {"scan", "clearance"}  # silent if the lidar is dead
MAX_REPORT_AGE = 0.2  # s between a report's stamp and its arrival, enough for a busy machine


@check(
    points=3,
    covers=("monitor", "level", "silent", "silent-field", "health-header"),
    needs=("build",),
    after=("processor", "controller", "monitor", "readings"),
    doc=contract.NODES_DOC,
)
@hint("A topic on which nothing has arrived is silent from the first report on: start with None for each topic.")
@hint("The time at which a message arrives counts: use self.get_clock().now(), not the message's stamp.")
@hint("FAILED if any topic is silent; else DEGRADED if the newest clearance is not valid; else OK.")
def test_health_levels(system: System, lone_monitor: SharedSystem, draw: random.Random) -> None:
    """status_monitor reports twice a second: FAILED before the first scan, OK when all is well, DEGRADED when blind."""
    first_reports = system.before_first_scan.reports
    _expect_reports(first_reports[-1:], FAILED, LIDAR_TOPICS, "Before the first scan")
    # The controller may start later than the monitor, so cmd_vel may be silent at first, too.
    early_report = next(
        (
            report.message
            for report in first_reports
            if report.message.level != FAILED or not silent_topics(report) >= LIDAR_TOPICS
        ),
        None,
    )
    description = "" if early_report is None else describe(early_report)
    expect(
        early_report is None,
        f"Before the first scan, an early report had {description}, although no scan had arrived.",
        fraction=0.5,
    )
    start = system.seconds
    reports = system.publish_scans(OPEN, 2.5).reports
    _expect_reports(reports, OK, set(), "With scans for 2.5 s", fraction=0.25)
    rate = system.harness.rate("/health", start)
    expect(1.6 <= rate <= 2.4, f"{MONITOR} published {rate:.1f} reports a second, instead of 2.", fraction=0.5)
    _expect_report_stamp(system, reports[-1])
    blind_reports = system.publish_scans(scan(Part(-35.0, 35.0, math.nan)), 1.0).reports
    _expect_reports(blind_reports[-1:], DEGRADED, set(), "With nan from every beam ahead", fraction=0.5)
    monitor = lone_monitor.get(MONITOR)
    silent_reports = monitor.before_first_scan.reports
    _expect_reports(silent_reports, FAILED, {*WATCHED_TOPICS}, "Before the first message on any topic", fraction=0.5)
    heard_topics = draw.sample(WATCHED_TOPICS, draw.choice((1, 2)))
    for _ in range(12):
        send_all(monitor, heard_topics)
    situation = f"With messages only on {' and '.join(heard_topics)} since the start"
    never_heard = {*WATCHED_TOPICS} - {*heard_topics}
    _expect_reports(monitor.messages(0.0).reports[-1:], FAILED, never_heard, situation, fraction=0.5)
    expect_each(
        seeing(), lambda history: expect_reports(monitor, history, fraction=0.5), draw, count=_case_count(monitor, 6)
    )


@check(
    points=3, covers=("silent", "silent-field", "monitor", "health-header"), needs=("build",), after=("health_levels",)
)
@hint("Remember when each topic was last heard, by self.get_clock().now(), and compare in the timer's callback.")
@hint("The callback of a silent topic is not called, so only a timer's callback can notice the silence.")
def test_dead_sensor(
    system: System, slow_system: SharedSystem, lone_monitor: SharedSystem, draw: random.Random
) -> None:
    """Health is FAILED and lists the silent topics within 2 s of the lidar's death, and OK within 2 s of its return."""
    system.publish_scans(OPEN, 2.0)
    start = system.seconds
    reports = system.wait(4.0).reports
    first_failure = next((r for r in reports if r.message.level == FAILED), None)
    delay = "was never FAILED" if first_failure is None else f"was FAILED after {first_failure.seconds - start:.1f} s"
    expect(
        first_failure is not None and first_failure.seconds - start <= REPORT_DEADLINE,
        f"The lidar died, and health {delay}. The limit is {REPORT_DEADLINE:.0f} s.",
    )
    is_paced = message_period.is_paced(reports, 0.5, system.harness.time)
    expect(
        is_paced,
        f"{MONITOR} published a report {message_period.describe_pace(reports)}, instead of twice a second.",
        fraction=0.5,
    )
    later_reports = [r for r in reports if r.seconds - start > REPORT_DEADLINE]
    _expect_reports(later_reports, FAILED, LIDAR_TOPICS, "2 to 4 s after the last scan", fraction=0.5)
    if system.harness.time == LOCKSTEP:  # in real time, the clocks of the machine cannot be slowed
        _expect_ros_time(slow_system.get(*PROGRAMS))
    monitor = lone_monitor.get(MONITOR)
    expect_reports(monitor, SCANS_STAMPED_AHEAD, fraction=0.75)
    expect_reports(monitor, ONE_SILENT_TOPIC, fraction=0.75)
    expect_each(
        silences(), lambda history: expect_reports(monitor, history, fraction=0.75), draw, count=_case_count(monitor, 8)
    )


def _case_count(system: System, count: int) -> int:
    """Return how many drawn histories a check can afford: fewer in real time."""
    return count if system.harness.time == LOCKSTEP else 2


def _expect_ros_time(system: System) -> None:
    """Fail the check if the monitor measures silence by a clock other than ROS time."""
    system.publish_scans(OPEN, 2.0)
    reports = system.wait(REPORT_DEADLINE).reports
    _expect_reports(
        reports[-1:], FAILED, LIDAR_TOPICS, f"{REPORT_DEADLINE:.0f} s of ROS time after the last scan", fraction=0.5
    )
    _expect_report_stamp(system, reports[-1])


def _expect_report_stamp(system: System, report: ReceivedMessage) -> None:
    """Fail the check unless a report's stamp is the ROS time at which it was published."""
    stamp = report.message.header.stamp
    arrival = system.harness.now_ns / 1e9 - (system.seconds - report.seconds)
    age = arrival - (stamp.sec + stamp.nanosec / 1e9)
    expect(stamp.sec != 0, "The stamp of health is 0: it was never set.", fraction=0.5)
    expect(
        abs(age) <= MAX_REPORT_AGE,
        f"By its stamp, a report on health was {age:.1f} s old when it arrived.",
        fraction=0.5,
    )


def _expect_reports(
    reports: Sequence[ReceivedMessage], level: int, silent: set[str], situation: str, *, fraction: float = 0.0
) -> None:
    """Fail the check unless there is a report, and each one has this level and these silent topics."""
    expect(bool(reports), f"{situation}, no report was published on health.", fraction=fraction)
    expected = report_text(level, sorted(silent))
    for report in reports:
        expect(
            report.message.level == level and silent_topics(report) == silent,
            f"{situation}, health had {describe(report.message)}, instead of {expected}.",
            fraction=fraction,
        )
