"""Runs the student's tests on the package as it is, and on mutants that the course provides."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace, check, expect, hint
from autograder.checking.probes import linters, student_test_reports, student_test_runs, versions
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.assertions import expect_no_sleep, expect_passed
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LIMITS, MIN_TESTS, PACKAGE, SCRIPTS

Reports = dict[tuple[str, str], student_test_reports.Report]
GUARD_FILE = "speed_guard/guard.py"

# These mutants differ a lot from the correct package. Each hidden one differs in about one line.
LETS_ALL_PASS = {"speed_guard/limits.py": "def safe_speed(wanted, *distances, **more_distances):\n    return wanted\n"}
GOES_BLIND = {
    "speed_guard/limits.py": """import math


def safe_speed(wanted, distance, stop_distance=0.5, slow_distance=1.5):
    if not 0.0 <= stop_distance < slow_distance:
        raise ValueError('these distances make no sense')
    if wanted <= 0.0 or distance is None or math.isnan(distance):
        return wanted
    share = (distance - stop_distance) / (slow_distance - stop_distance)
    return wanted * min(1.0, max(0.0, share))
"""
}
HALF_IN_BETWEEN = {
    "speed_guard/limits.py": """import math


def safe_speed(wanted, distance, stop_distance=0.5, slow_distance=1.5):
    if not 0.0 <= stop_distance < slow_distance:
        raise ValueError('these distances make no sense')
    if wanted <= 0.0:
        return wanted
    if distance is None or math.isnan(distance) or distance <= stop_distance:
        return 0.0
    return wanted if distance >= slow_distance else wanted / 2.0
"""
}
# The next two are appended to guard.py.
NEVER_FORGETS = """

_answer = SpeedGuard.on_command


def _trusting(self, msg):
    self.distance_time = self.get_clock().now()
    _answer(self, msg)


SpeedGuard.on_command = _trusting
"""
TURNS_THE_OTHER_WAY = """

_answer = SpeedGuard.on_command


def _turned(self, msg):
    msg.angular.z *= -1.0
    _answer(self, msg)


SpeedGuard.on_command = _turned
"""
WITHOUT_CONFIGURATION = {
    "launch/guard.launch.py": """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='speed_guard', executable='speed_guard', name='speed_guard')])
"""
}
ORIGINAL, ALL_PASS, BLIND, HALF = "original", "all pass", "blind", "half"
TURNED, TRUSTING, UNCONFIGURED = "turned", "trusting", "unconfigured"


@pytest.fixture(scope="module")
def source(workspace: Workspace) -> student_test_reports.Source:
    """The student's package."""
    return student_test_runs.read_source(workspace, PACKAGE)


@pytest.fixture(scope="module")
def reports(workspace: Workspace, source: student_test_reports.Source) -> Reports:
    """The reports of each file's tests on the package as it is, and on its mutants."""
    files = {name: data.decode(errors="replace") for name, data in source.files.items() if not name.startswith("test/")}
    mutants: dict[tuple[str, str], dict[str, str]] = {
        (LAUNCH, UNCONFIGURED): WITHOUT_CONFIGURATION,
        (GUARD, ALL_PASS): LETS_ALL_PASS,
        (GUARD, TURNED): {GUARD_FILE: files.get(GUARD_FILE, "") + TURNS_THE_OTHER_WAY},
        (LIMITS, ALL_PASS): LETS_ALL_PASS,
        (GUARD, TRUSTING): {GUARD_FILE: files.get(GUARD_FILE, "") + NEVER_FORGETS},
        (LIMITS, BLIND): GOES_BLIND,
        (LIMITS, HALF): HALF_IN_BETWEEN,
    }
    runs = {
        (name, ORIGINAL): student_test_reports.TestRun(
            (name,), versions.Version(files, SCRIPTS), sniffed=name == GUARD, is_public=True
        )
        for name in MIN_TESTS
    }
    for (name, mutant), changed_files in mutants.items():
        runs[name, mutant] = student_test_reports.TestRun(
            (name,), versions.Version({**files, **changed_files}, SCRIPTS), exit_first=True, is_public=True
        )
    runs = {key: run for key, run in runs.items() if key[0] in source.tests}
    return dict(zip(runs, student_test_runs.run(workspace, source, list(runs.values())), strict=True))


@check(points=1, covers="limits-pass", group="function", doc=contract.PYTEST)
@hint("Run them: shell('cd ws/src/speed_guard && python -m pytest test/test_limits.py').", contract.ALL_PASS)
def test_limits_pass(reports: Reports) -> None:
    """At least six tests in test_limits.py run, and all pass on the package as it is."""
    expect_passed(LIMITS, reports.get((LIMITS, ORIGINAL)))


@check(points=1, covers="function-lines", group="function", needs=("limits_pass",), doc=contract.PYTEST)
@hint("Which line of the contract says that the robot stops?", contract.MUTATE)
def test_limits_notice(reports: Reports) -> None:
    """A test in test_limits.py fails when safe_speed returns the wanted speed, whatever is ahead."""
    _expect_detection(reports, LIMITS, ALL_PASS)


@check(points=1, covers="unknown", group="function", needs=("limits_pass",), doc=contract.PYTEST)
@hint("A distance is unknown in two ways: None and math.nan.", contract.MUTATE)
def test_limits_unknown(reports: Reports) -> None:
    """A test in test_limits.py fails when safe_speed treats an unknown distance as a clear way."""
    _expect_detection(reports, LIMITS, BLIND)


@check(points=1, covers="slow", group="function", needs=("limits_pass",), doc=contract.PYTEST)
@hint("Half-way, half the speed is correct. What is correct at a quarter of the way?", contract.MUTATE)
def test_limits_line(reports: Reports) -> None:
    """A test in test_limits.py fails when safe_speed returns half the wanted speed anywhere between the distances."""
    _expect_detection(reports, LIMITS, HALF)


@check(points=1, covers="guard-pass", group="node", doc=contract.PYTEST)
@hint("Run them: shell('cd ws/src/speed_guard && python -m pytest test/test_guard.py').", contract.ALL_PASS)
@hint(contract.SPIN, "self.test_executor.spin_once(timeout_sec=0.05), as in spin. Then look at the clock.")
def test_guard_pass(reports: Reports) -> None:
    """At least five tests in test_guard.py run, and all pass on the package as it is."""
    expect_passed(GUARD, reports.get((GUARD, ORIGINAL)))


@check(points=1, covers="node-lines", group="node", needs=("guard_pass",), doc=contract.PYTEST)
@hint("What should robot.ask(0.8) return after robot.see(0.2)?", contract.MUTATE)
def test_guard_notice(reports: Reports) -> None:
    """A test in test_guard.py fails when the guard lets every command pass."""
    _expect_detection(reports, GUARD, ALL_PASS)


@check(points=1, covers="turn", group="node", needs=("guard_pass",), doc=contract.PYTEST)
@hint("robot.ask(0.5, 0.7) returns the whole answer: look at angular.z, too.", contract.MUTATE)
def test_guard_turn(reports: Reports) -> None:
    """A test in test_guard.py fails when the guard turns to the other side."""
    _expect_detection(reports, GUARD, TURNED)


@check(points=1, covers="stale", group="node", needs=("guard_pass",), doc=contract.PYTEST)
@hint("With guard(timeout=HASTY): see(4.0), spin for longer than HASTY, and then ask(0.8).", contract.MUTATE)
def test_guard_forgets(reports: Reports) -> None:
    """A test in test_guard.py fails when the guard uses a distance, however old it is."""
    _expect_detection(reports, GUARD, TRUSTING)


@check(points=1, covers="own-domain", group="node", needs=("guard_pass",), doc=contract.DOMAIN)
@hint("rclpy.init(context=context, domain_id=domain) in the fixture, and context=context for each node.")
def test_alone(reports: Reports) -> None:
    """While test_guard.py runs, none of its nodes is in the default domain."""
    message = "One of its nodes was in the default domain, where other robots could hear it."
    expect(not reports[GUARD, ORIGINAL].joined_domain, message)


@check(points=1, covers="no-sleep", group="node", needs=("guard_pass",), doc=contract.PYTEST)
@hint(*contract.NO_SLEEP)
def test_no_sleep(source: student_test_reports.Source) -> None:
    """No test waits with time.sleep."""
    expect_no_sleep(source)


@check(points=1, covers="write-launch-test", group="launch", doc=contract.INTEGRATION)
@hint(contract.SAME_DOMAIN, contract.WAIT)
def test_launch_pass(reports: Reports) -> None:
    """A test in test_launch.py runs, and passes on the package as it is."""
    expect_passed(LAUNCH, reports.get((LAUNCH, ORIGINAL)))


@check(points=1, covers="launch-promise", group="launch", needs=("launch_pass",), doc=contract.INTEGRATION)
@hint("At which distance do a guard with config/guard.yaml and one with the defaults answer differently?")
@hint("At 0.4 m, a guard with the defaults stops, and one with the configuration does not.")
def test_launch_notice(reports: Reports) -> None:
    """A test in test_launch.py fails when the launch file does not use config/guard.yaml."""
    _expect_detection(reports, LAUNCH, UNCONFIGURED)


@check(points=1, covers="linters", group="craft", doc=contract.CLI)
@hint("Run `ament_flake8` and `ament_pep257` in ws/src/speed_guard: they print file and line.")
def test_linters(workspace: Workspace, source: student_test_reports.Source) -> None:
    """The linters flake8 and pep257 find nothing in the package and in your tests."""
    findings = linters.lint(workspace, source)
    expect(not findings, "; ".join(f"{name}: {finding}" for name, finding in findings.items()))


def _expect_detection(reports: Reports, name: str, mutant: str) -> None:
    is_detected = reports[name, mutant].detects_fault(reports[name, ORIGINAL])
    expect(is_detected, f"All tests in {name} also pass on that mutant.")
