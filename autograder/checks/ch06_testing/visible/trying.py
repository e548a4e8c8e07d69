"""The student's tests on the package as it is, and on mutants that anybody would think of."""

from __future__ import annotations

import pytest

from autograder.checks import check, expect, hint
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.assertions import expect_no_sleep, expect_passed
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LEAST, LIMITS, PACKAGE, SCRIPTS
from autograder.harness import Workspace
from autograder.probes.test_reports import Report, Source, TestRun
from autograder.probes.test_runs import run, take
from autograder.probes.versions import Version

Reports = dict[tuple[str, str], Report]

# Two mutants that anybody would think of. The hidden ones are less obvious.
LETS_ALL_PASS = {"speed_guard/limits.py": "def safe_speed(wanted, *distances, **more_distances):\n    return wanted\n"}
WITHOUT_CONFIGURATION = {
    "launch/guard.launch.py": """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package='speed_guard', executable='speed_guard', name='speed_guard')])
"""
}
MUTANTS = {LIMITS: LETS_ALL_PASS, GUARD: LETS_ALL_PASS, LAUNCH: WITHOUT_CONFIGURATION}
RIGHT, MUTANT = "right", "mutant"


@pytest.fixture(scope="module")
def source(workspace: Workspace) -> Source:
    """The student's package."""
    return take(workspace, PACKAGE)


@pytest.fixture(scope="module")
def reports(workspace: Workspace, source: Source) -> Reports:
    """What the tests of each file say of the package as it is, and of a mutant."""
    files = {name: data.decode(errors="replace") for name, data in source.files.items() if not name.startswith("test/")}
    version = Version(files, SCRIPTS)
    wanted: dict[tuple[str, str], TestRun] = {}
    for name in LEAST:
        if name in source.tests:
            wanted[name, RIGHT] = TestRun((name,), version)
            mutant = Version({**version.files, **MUTANTS[name]}, SCRIPTS)
            wanted[name, MUTANT] = TestRun((name,), mutant, first_failure=True)
    return dict(zip(wanted, run(workspace, source, list(wanted.values())), strict=True))


@check(points=1, holds="limits-pass", group="function", doc=contract.PYTEST)
@hint("Run them: shell('cd ws/src/speed_guard && python -m pytest test/test_limits.py').", contract.ALL_PASS)
def test_limits_pass(reports: Reports) -> None:
    """At least six tests in test_limits.py run, and all pass on the package as it is."""
    expect_passed(LIMITS, reports.get((LIMITS, RIGHT)))


@check(points=1, holds="function-lines", group="function", depends=("limits_pass",), doc=contract.PYTEST)
@hint("Which line of the contract says that it stops?", contract.MUTATE)
def test_limits_notice(reports: Reports) -> None:
    """One of them fails when safe_speed returns what was wanted, whatever is ahead."""
    _expect_objection(reports, LIMITS)


@check(points=1, holds="guard-pass", group="node", doc=contract.PYTEST)
@hint(contract.SPIN, "Between two calls of spin_once, look at the condition and at time.monotonic().")
def test_guard_pass(reports: Reports) -> None:
    """At least five tests in test_guard.py run, and all pass on the package as it is."""
    expect_passed(GUARD, reports.get((GUARD, RIGHT)))


@check(points=1, holds="node-lines", group="node", depends=("guard_pass",), doc=contract.PYTEST)
@hint("robot.see(0.2), and then?", contract.MUTATE)
def test_guard_notice(reports: Reports) -> None:
    """One of them fails when the guard lets every command pass."""
    _expect_objection(reports, GUARD)


@check(points=1, holds="no-sleep", group="node", depends=("guard_pass",), doc=contract.PYTEST)
@hint(*contract.NO_SLEEP)
def test_no_sleep(source: Source) -> None:
    """No test waits with time.sleep."""
    expect_no_sleep(source)


@check(points=1, holds="write-launch-test", group="launch", doc=contract.INTEGRATION)
@hint(contract.SAME_DOMAIN, contract.WAIT)
def test_launch_pass(reports: Reports) -> None:
    """A test in test_launch.py runs, and passes on the package as it is."""
    expect_passed(LAUNCH, reports.get((LAUNCH, RIGHT)))


@check(points=1, holds="launch-promise", group="launch", depends=("launch_pass",), doc=contract.INTEGRATION)
@hint("At which distance does a guard with config/guard.yaml answer otherwise than one with the defaults?")
@hint("At 0.4 m: the defaults say stop, the configuration does not.")
def test_launch_notice(reports: Reports) -> None:
    """It fails when the launch file forgets config/guard.yaml."""
    _expect_objection(reports, LAUNCH)


def _expect_objection(reports: Reports, name: str) -> None:
    objects = reports[name, MUTANT].objects(reports[name, RIGHT])
    expect(objects, f"All tests in {name} pass on that mutant, too.")
