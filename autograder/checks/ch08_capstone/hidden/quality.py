"""Step 7: colcon test runs the tests and the linters, and all of them pass."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace, expect, group, hint, solution_path
from autograder.checking.probes import colcon_test, given_files, linters, student_test_reports, student_test_runs
from autograder.checks.ch08_capstone.hidden.launched import expect_reaction_to_scans
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import PACKAGE

check = group("step_7", doc=contract.TESTING_DOC)
LINTERS = ("test_flake8::test_flake8", "test_pep257::test_pep257")
MAX_SHOWN = 5  # the largest number of failed tests that a message shows
GIVEN_FILES = ("test/test_integration.py", "test/conftest.py")


@pytest.fixture(scope="module")
def colcon_report(workspace: Workspace) -> student_test_reports.Report:
    """The report of colcon test, which runs once for all checks."""
    return colcon_test.colcon_test(workspace, PACKAGE)


@check(points=2, covers="pytest", needs=("build",), after=("interface_package",))
@hint("Without extras_require={'test': ['pytest']} in setup.py, colcon runs no tests and exits with status 0.")
@hint("test_flake8.py, test_pep257.py and test_integration.py have to be in test/, too.")
def test_colcon_finds_tests(colcon_report: student_test_reports.Report) -> None:
    """Colcon test finds the package's tests: the student's own, the integration test and both linters."""
    colcon_test.expect_ended(colcon_report)
    executed_tests = colcon_report.executed
    expect(bool(executed_tests), "colcon test ran no tests at all.")
    modules = sorted({test.partition("::")[0] for test in executed_tests})
    broken_messages = [
        f" {test}: {message}"
        for test, message in colcon_report.claims.messages.items()
        if message and test in executed_tests
    ]
    for name in ("test_sectors", "test_integration", "test_flake8", "test_pep257"):
        expect(
            name in modules,
            f"No test of {name}.py ran. Modules whose tests ran: {', '.join(modules)}.{''.join(broken_messages[:1])}",
        )


@check(points=2, covers="linters", needs=("build",), after=("colcon_finds_tests",))
@hint("Run colcon test in a terminal, then colcon test-result --all --verbose.")
@hint("The linters name a file, a line and a rule: fix them one by one.")
def test_linters_pass(workspace: Workspace, colcon_report: student_test_reports.Report) -> None:
    """The linters flake8 and pep257 report no errors."""
    for name in LINTERS:
        outcome = colcon_report.claims.verdicts.get(name)
        expect(
            outcome is student_test_reports.ClaimedOutcome.PASSED,
            f"{name}: {colcon_report.claims.messages.get(name) or 'it did not run'}",
        )
    linters.expect_tidy(workspace, student_test_runs.read_source(workspace, PACKAGE), LINTERS)


@check(
    points=2,
    covers=("integration", "sector-tests"),
    needs=("build",),
    after=(
        "colcon_finds_tests",
        "qos",
        "readings",
        "turns",
        "stops",
        "enable",
        "dead_sensor",
        "launch_starts",
        "config",
    ),
)
@hint("Run colcon test in a terminal, then colcon test-result --all --verbose.")
@hint("test_integration.py starts your launch file: the robot has to drive while scans arrive, and stop when they end.")
def test_tests_pass(workspace: Workspace, colcon_report: student_test_reports.Report) -> None:
    """Every test of the package passes, the launched robot reacts to scans, and the given test is unchanged."""
    expect(
        any(name not in LINTERS for name in colcon_report.executed),
        "colcon test ran no tests except those of the linters.",
    )
    failed_tests = [name for name in colcon_report.failed if name not in LINTERS]
    messages = colcon_report.claims.messages
    failures = "; ".join(f"{name}: {messages.get(name, '')}" for name in failed_tests[:MAX_SHOWN])
    expect(not failed_tests, f"{len(failed_tests)} of {len(colcon_report.executed)} tests fail: {failures}")
    expect_reaction_to_scans(workspace)
    files, solution = student_test_runs.read_source(workspace, PACKAGE).files, solution_path(PACKAGE)
    changed_names = given_files.changed_files(
        files, {name: (solution / name).read_bytes() for name in GIVEN_FILES}, ("test",)
    )
    expect(not changed_names, f"Given files that were changed: {' and '.join(changed_names)}.", fraction=0.5)
