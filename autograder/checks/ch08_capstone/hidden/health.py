"""Step 2, the monitor: what it says of the others, and how soon."""

from __future__ import annotations

import math

from autograder.checks import expect, group, hint
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.edges import OPEN
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    DEGRADED,
    FAILED,
    MONITOR,
    OK,
    PARAMETERS,
    PROGRAMS,
    SAID_WITHIN,
)
from autograder.checks.ch08_capstone.support.system import SharedSystem, System, describe_report
from autograder.harness import Stamped
from autograder.probes.pace import is_paced, mean_period
from autograder.time_record import LOCKSTEP

check = group("step_2")
DEAD = {"scan", "clearance"}  # what falls silent with the lidar
SILENT = PARAMETERS[MONITOR]["silence_timeout"].default
MARGIN = 0.1  # s
STAMPED = 0.2  # s between a report's stamp and its arrival, generous for a machine that is busy


@check(
    points=3,
    holds=("monitor", "level", "health-header"),
    depends=("processor", "controller", "monitor"),
    doc=contract.NODES_DOC,
)
@hint("A topic that was never heard is silent, too: start with None for each.")
@hint("FAILED if any topic is silent; else DEGRADED if the newest clearance is not valid; else OK.")
def test_health_levels(system: System) -> None:
    """Twice a second it reports: FAILED before anything was seen, OK when all is well, DEGRADED when blind."""
    _expect_report(system.first.reports[-1:], FAILED, DEAD, "Before the first scan")
    began = system.seconds
    system.see(OPEN, 3.0)
    reports = system.messages(began).reports
    _expect_report(reports[-1:], OK, set(), "With scans for 3 s", fraction=0.25)
    rate = system.harness.rate("/health", began)
    expect(1.6 <= rate <= 2.4, f"It published {rate:.1f} reports a second, instead of 2.", fraction=0.5)
    _expect_stamped(system, reports[-1])
    blind = system.see(scan(Part(-35.0, 35.0, math.nan)), 2.0)
    _expect_report(blind.reports[-1:], DEGRADED, set(), "With nan from every beam ahead", fraction=0.5)


@check(points=3, holds=("silent", "silent-field", "monitor", "health-header"), depends=("health_levels",))
@hint("Remember when each topic was last heard, by self.get_clock().now(), and compare in the timer's callback.")
@hint("A callback of the dead topic cannot tell that it is dead: only a timer can.")
def test_dead_sensor(system: System, slow_system: SharedSystem) -> None:
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
    period = mean_period(reports)
    paced = is_paced(period, 0.5, system.harness.time)
    expect(paced, f"It published a report every {period:.2f} s, instead of two a second.", fraction=0.5)
    _expect_report(reports[-1:], FAILED, DEAD, "4 s after the last scan", fraction=0.5)
    system.see(OPEN, SAID_WITHIN)
    back = system.harness.messages("/health")[-1:]
    _expect_report(back, OK, set(), f"{SAID_WITHIN:.0f} s after the lidar came back", fraction=0.75)
    if system.harness.time == LOCKSTEP:  # elsewhere the machine's clocks are as they are
        _expect_ros_time(slow_system.get(*PROGRAMS))


def _expect_ros_time(system: System) -> None:
    """Fail the check if silence is measured by another clock than that of ROS."""
    system.see(OPEN, 2.0)
    reports = system.wait(SAID_WITHIN).reports
    _expect_report(reports[-1:], FAILED, DEAD, f"{SAID_WITHIN:.0f} s of ROS time after the last scan", fraction=0.5)
    _expect_stamped(system, reports[-1])


def _expect_stamped(system: System, report: Stamped) -> None:
    """Fail the check unless a report's stamp is the ROS time at which it was made."""
    stamp = report.message.header.stamp
    came = system.harness.now_ns / 1e9 - (system.seconds - report.seconds)
    age = came - (stamp.sec + stamp.nanosec / 1e9)
    expect(stamp.sec != 0, "The stamp of health is 0: it was never set.", fraction=0.5)
    expect(abs(age) <= STAMPED, f"By its stamp, a report of health was {age:.1f} s old when it came.", fraction=0.5)


def _expect_report(
    reports: tuple[Stamped, ...] | list[Stamped], level: int, silent: set[str], situation: str, *, fraction: float = 0.0
) -> None:
    """Fail the check unless there is a report with this level that names these topics."""
    expect(bool(reports), f"{situation}, no report came on health.", fraction=fraction)
    report = reports[0].message
    given = {str(topic).lstrip("/") for topic in report.silent}
    wanted = f"level {contract.LEVELS[level]}, silent: {', '.join(sorted(silent)) or 'none'}"
    expect(
        report.level == level and given == silent,
        f"{situation}, health said {describe_report(report)}; the contract asks {wanted}.",
        fraction=fraction,
    )
