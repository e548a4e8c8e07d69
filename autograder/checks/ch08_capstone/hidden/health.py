"""Step 2, the monitor: what it says of the others, and how soon."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from geometry_msgs.msg import Twist

from autograder.checking import LOCKSTEP, SCAN_SECONDS, ReceivedMessage, expect, group, hint
from autograder.checking.probes import message_period
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    DEGRADED,
    FAILED,
    MONITOR,
    OK,
    PARAMETERS,
    PROGRAMS,
    SAID_WITHIN,
    WATCHED,
)
from autograder.checks.ch08_capstone.support.system import SETTLED, SharedSystem, System, describe_report

check = group("step_2")
DEAD = {"scan", "clearance"}  # what falls silent with the lidar
SILENT = PARAMETERS[MONITOR]["silence_timeout"].default
MARGIN = 0.1  # s
REAL_MARGIN = 0.25  # s, where time is real
LATE, EARLY = 5.0, -2.0  # s: how old the stamps of a lidar with another clock are; of 2 s ahead, more than SILENT
STAMPED = 0.2  # s between a report's stamp and its arrival, generous for a machine that is busy
# s from a report to the last message of a topic. At two reports a second, one falls 1.15 to 1.25 s after that message.
PHASE, PHASE_END = 0.25, 0.35


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
    first = system.first.reports
    _expect_reports(first[-1:], FAILED, DEAD, "Before the first scan")
    # The controller may begin later, so that cmd_vel is silent, too, at first.
    early = next((r.message for r in first if r.message.level != FAILED or not _silent(r) >= DEAD), None)
    said = "" if early is None else describe_report(early)
    expect(early is None, f"Before the first scan, an early report said {said}: nothing was heard yet.", fraction=0.5)
    began = system.seconds
    reports = system.see(OPEN, 3.0).reports
    _expect_reports(reports, OK, set(), "With scans for 3 s", fraction=0.25)
    rate = system.harness.rate("/health", began)
    expect(1.6 <= rate <= 2.4, f"It published {rate:.1f} reports a second, instead of 2.", fraction=0.5)
    _expect_stamped(system, reports[-1])
    blind = system.see(scan(Part(-35.0, 35.0, math.nan)), 2.0).reports
    _expect_reports(blind, DEGRADED, set(), "With nan from every beam ahead", fraction=0.5)
    dead = system.wait(SAID_WITHIN).reports[-1:]
    _expect_reports(dead, FAILED, DEAD, f"{SAID_WITHIN:.0f} s after the last scan, a blind one", fraction=0.5)
    _expect_reports(system.see(OPEN, 1.0).reports, OK, set(), "When it sees again", fraction=0.5)
    late = system.see(OPEN, 1.5, age=LATE).reports
    _expect_reports(late, OK, set(), f"With scans that arrive, stamped {LATE:.0f} s earlier", fraction=0.5)
    alone = lone_monitor.get(MONITOR)
    undriven = _send_all(alone, ("scan", "clearance"), 1.5)
    _expect_reports(undriven, FAILED, {"cmd_vel"}, "With scans, and no controller that runs", fraction=0.5)
    half_blind = _send_all(alone, WATCHED, 1.0, left=math.nan)[-1:]
    situation = "With a clearance that is not valid, as it has nan on the left alone"
    _expect_reports(half_blind, DEGRADED, set(), situation, fraction=0.85)


@check(
    points=3, covers=("silent", "silent-field", "monitor", "health-header"), needs=("build",), after=("health_levels",)
)
@hint("Remember when each topic was last heard, by self.get_clock().now(), and compare in the timer's callback.")
@hint("A callback of the dead topic cannot tell that it is dead: only a timer can.")
def test_dead_sensor(system: System, slow_system: SharedSystem, lone_monitor: SharedSystem) -> None:
    """Within 2 s of a lidar's death health is FAILED and names what is silent; within 2 s of its return it is OK."""
    system.see(OPEN, 2.0)
    began = system.seconds
    reports = system.wait(4.0).reports
    soon = next((r for r in reports if r.message.level == FAILED), None)
    late = "never" if soon is None else f"only {soon.seconds - began:.1f} s after"
    expect(soon is not None and soon.seconds - began <= SAID_WITHIN, f"The lidar died, and health was FAILED {late}.")
    hasty = [r for r in reports if r.message.level == FAILED and r.seconds - began < SILENT - MARGIN]
    said = f"Health was FAILED less than {SILENT:.0f} s after the last scan: that is no silence yet."
    expect(not hasty, said, fraction=0.5)
    paced = message_period.is_paced(reports, 0.5, system.harness.time)
    expect(
        paced, f"It published a report {message_period.describe_pace(reports)}, instead of two a second.", fraction=0.5
    )
    later = [r for r in reports if r.seconds - began > SAID_WITHIN]
    _expect_reports(later, FAILED, DEAD, "2 to 4 s after the last scan", fraction=0.5)
    system.see(OPEN, SAID_WITHIN)
    back = system.harness.messages("/health")[-1:]
    _expect_reports(back, OK, set(), f"{SAID_WITHIN:.0f} s after the lidar came back", fraction=0.75)
    system.see(OPEN, 1.0, age=EARLY)
    again = system.wait(SAID_WITHIN).reports[-1:]
    said = f"{SAID_WITHIN:.0f} s after the last scan, whose stamp was {-EARLY:.0f} s ahead of the clock,"
    _expect_reports(again, FAILED, DEAD, said, fraction=0.75)
    if system.harness.time == LOCKSTEP:  # elsewhere the machine's clocks are as they are
        _expect_ros_time(slow_system.get(*PROGRAMS))
    for topic in ("cmd_vel", "clearance"):
        _expect_silence_reported(lone_monitor.get(MONITOR), topic)


def _expect_ros_time(system: System) -> None:
    """Fail the check if silence is measured by another clock than that of ROS."""
    system.see(OPEN, 2.0)
    reports = system.wait(SAID_WITHIN).reports
    _expect_reports(reports[-1:], FAILED, DEAD, f"{SAID_WITHIN:.0f} s of ROS time after the last scan", fraction=0.5)
    _expect_stamped(system, reports[-1])


def _expect_silence_reported(system: System, topic: str) -> None:
    """Fail the check unless a topic is called silent once it has been for longer than the time-out, the others not."""
    _send_all(system, WATCHED, 0.5)
    repeat_until_after_report(system, lambda: _send_all(system, WATCHED, SCAN_SECONDS))
    margin = MARGIN if system.harness.time == LOCKSTEP else REAL_MARGIN
    ended = system.seconds
    _send_all(system, [other for other in WATCHED if other != topic], SAID_WITHIN)
    late = system.messages(ended + SILENT + margin).reports
    situation = f"More than {SILENT:.0f} s after the last message on {topic}, while the others went on"
    _expect_reports(late, FAILED, {topic}, situation, fraction=0.85)


def repeat_until_after_report(system: System, step: Callable[[], object]) -> None:
    """Repeat a step of 0.1 s until the newest report is about 0.3 s old, 10 times at most.

    Then the next report comes at the same time after the step, whichever checks ran before.
    """
    for _ in range(10):
        newest = system.harness.messages("/health")[-1:]
        if newest and PHASE <= system.seconds - newest[0].seconds < PHASE_END:
            return
        step()


def _send_all(system: System, topics: Sequence[str], seconds: float, **distances: float) -> Sequence[ReceivedMessage]:
    """Send the lone monitor a message on each topic ten times a second; return the reports after the time to react.

    The clearance is valid and free to all sides, but for these distances.
    """
    began, valid = system.seconds, not any(map(math.isnan, distances.values()))
    free = {"front": math.inf, "left": math.inf, "right": math.inf}
    clearance = system.types.clearance(valid=valid, **{**free, **distances})
    messages: dict[str, Any] = {"scan": OPEN, "clearance": clearance, "cmd_vel": Twist()}
    for _ in range(round(seconds / SCAN_SECONDS)):
        for topic in topics:
            system.send(f"/{topic}", messages[topic])
        system.harness.run(SCAN_SECONDS)
    return system.messages(began + SETTLED).reports


def _expect_stamped(system: System, report: ReceivedMessage) -> None:
    """Fail the check unless a report's stamp is the ROS time at which it was made."""
    stamp = report.message.header.stamp
    came = system.harness.now_ns / 1e9 - (system.seconds - report.seconds)
    age = came - (stamp.sec + stamp.nanosec / 1e9)
    expect(stamp.sec != 0, "The stamp of health is 0: it was never set.", fraction=0.5)
    expect(abs(age) <= STAMPED, f"By its stamp, a report of health was {age:.1f} s old when it came.", fraction=0.5)


def _expect_reports(
    reports: Sequence[ReceivedMessage], level: int, silent: set[str], situation: str, *, fraction: float = 0.0
) -> None:
    """Fail the check unless there is a report, and each one has this level and names these topics."""
    expect(bool(reports), f"{situation}, no report came on health.", fraction=fraction)
    wanted = f"level {contract.LEVELS[level]}, silent: {', '.join(sorted(silent)) or 'none'}"
    for report in reports:
        expect(
            report.message.level == level and _silent(report) == silent,
            f"{situation}, health said {describe_report(report.message)}; the contract asks {wanted}.",
            fraction=fraction,
        )


def _silent(report: ReceivedMessage) -> set[str]:
    """Return the topics that a report calls silent."""
    return {str(topic).lstrip("/") for topic in report.message.silent}
