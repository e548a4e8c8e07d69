"""The student's tests on the package as it is, and on mutants that anybody would think of."""

from __future__ import annotations

from autograder.checks import Visibility, check, expect
from autograder.checks.ch06_testing.conftest import MUTANT, RIGHT
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LIMITS
from autograder.checks.ch06_testing.support.verdicts import expect_awake, expect_passed
from autograder.probes.test_reports import Report, Source

SEEN = Visibility.VISIBLE
Reports = dict[tuple[str, str], Report]


@check(
    points=1,
    group="function",
    visibility=SEEN,
    hints=("Run them: shell('cd ws/src/speed_guard && python -m pytest test/test_limits.py').", contract.ALL_PASS),
    doc=contract.PYTEST,
)
def test_limits_pass(reports: Reports) -> None:
    """At least six tests in test_limits.py run, and all pass on the package as it is."""
    expect_passed(LIMITS, reports.get((LIMITS, RIGHT)))


@check(
    points=1,
    group="function",
    visibility=SEEN,
    depends=("limits_pass",),
    hints=("Which line of the contract says that it stops?", contract.MUTATE),
    doc=contract.PYTEST,
)
def test_limits_notice(reports: Reports) -> None:
    """One of them fails when safe_speed returns what was wanted, whatever is ahead."""
    _expect_objection(reports, LIMITS)


@check(
    points=1,
    group="node",
    visibility=SEEN,
    hints=(contract.SPIN, "Between two calls of spin_once, look at the condition and at time.monotonic()."),
    doc=contract.PYTEST,
)
def test_guard_pass(reports: Reports) -> None:
    """At least five tests in test_guard.py run, and all pass on the package as it is."""
    expect_passed(GUARD, reports.get((GUARD, RIGHT)))


@check(
    points=1,
    group="node",
    visibility=SEEN,
    depends=("guard_pass",),
    hints=("robot.see(0.2), and then?", contract.MUTATE),
    doc=contract.PYTEST,
)
def test_guard_notice(reports: Reports) -> None:
    """One of them fails when the guard lets every command pass."""
    _expect_objection(reports, GUARD)


@check(
    points=1,
    group="node",
    visibility=SEEN,
    depends=("guard_pass",),
    hints=contract.NO_SLEEP,
    doc=contract.PYTEST,
)
def test_no_sleep(source: Source) -> None:
    """No test waits with time.sleep."""
    expect_awake(source)


@check(
    points=1,
    group="launch",
    visibility=SEEN,
    hints=(contract.SAME_DOMAIN, contract.WAIT),
    doc=contract.INTEGRATION,
)
def test_launch_pass(reports: Reports) -> None:
    """A test in test_launch.py runs, and passes on the package as it is."""
    expect_passed(LAUNCH, reports.get((LAUNCH, RIGHT)))


@check(
    points=1,
    group="launch",
    visibility=SEEN,
    depends=("launch_pass",),
    hints=(
        "At which distance does a guard with config/guard.yaml answer otherwise than one with the defaults?",
        "At 0.4 m: the defaults say stop, the configuration does not.",
    ),
    doc=contract.INTEGRATION,
)
def test_launch_notice(reports: Reports) -> None:
    """It fails when the launch file forgets config/guard.yaml."""
    _expect_objection(reports, LAUNCH)


def _expect_objection(reports: Reports, name: str) -> None:
    objects = reports[name, MUTANT].objects(reports[name, RIGHT])
    expect(objects, f"All tests in {name} pass on that mutant, too.")
