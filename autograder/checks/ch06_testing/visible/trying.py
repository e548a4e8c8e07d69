"""The student's tests on the package as it is, and on mutants that anybody would think of."""

from __future__ import annotations

from autograder.checks import check, expect, hint
from autograder.checks.ch06_testing.conftest import MUTANT, RIGHT
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, LIMITS
from autograder.checks.ch06_testing.support.verdicts import expect_awake, expect_passed
from autograder.probes.test_reports import Report, Source

Reports = dict[tuple[str, str], Report]


@check(points=1, group="function", doc=contract.PYTEST)
@hint("Run them: shell('cd ws/src/speed_guard && python -m pytest test/test_limits.py').", contract.ALL_PASS)
def test_limits_pass(reports: Reports) -> None:
    """At least six tests in test_limits.py run, and all pass on the package as it is."""
    expect_passed(LIMITS, reports.get((LIMITS, RIGHT)))


@check(points=1, group="function", depends=("limits_pass",), doc=contract.PYTEST)
@hint("Which line of the contract says that it stops?", contract.MUTATE)
def test_limits_notice(reports: Reports) -> None:
    """One of them fails when safe_speed returns what was wanted, whatever is ahead."""
    _expect_objection(reports, LIMITS)


@check(points=1, group="node", doc=contract.PYTEST)
@hint(contract.SPIN, "Between two calls of spin_once, look at the condition and at time.monotonic().")
def test_guard_pass(reports: Reports) -> None:
    """At least five tests in test_guard.py run, and all pass on the package as it is."""
    expect_passed(GUARD, reports.get((GUARD, RIGHT)))


@check(points=1, group="node", depends=("guard_pass",), doc=contract.PYTEST)
@hint("robot.see(0.2), and then?", contract.MUTATE)
def test_guard_notice(reports: Reports) -> None:
    """One of them fails when the guard lets every command pass."""
    _expect_objection(reports, GUARD)


@check(points=1, group="node", depends=("guard_pass",), doc=contract.PYTEST)
@hint(*contract.NO_SLEEP)
def test_no_sleep(source: Source) -> None:
    """No test waits with time.sleep."""
    expect_awake(source)


@check(points=1, group="launch", doc=contract.INTEGRATION)
@hint(contract.SAME_DOMAIN, contract.WAIT)
def test_launch_pass(reports: Reports) -> None:
    """A test in test_launch.py runs, and passes on the package as it is."""
    expect_passed(LAUNCH, reports.get((LAUNCH, RIGHT)))


@check(points=1, group="launch", depends=("launch_pass",), doc=contract.INTEGRATION)
@hint("At which distance does a guard with config/guard.yaml answer otherwise than one with the defaults?")
@hint("At 0.4 m: the defaults say stop, the configuration does not.")
def test_launch_notice(reports: Reports) -> None:
    """It fails when the launch file forgets config/guard.yaml."""
    _expect_objection(reports, LAUNCH)


def _expect_objection(reports: Reports, name: str) -> None:
    objects = reports[name, MUTANT].objects(reports[name, RIGHT])
    expect(objects, f"All tests in {name} pass on that mutant, too.")
