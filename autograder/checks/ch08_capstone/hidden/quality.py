"""Step 7: colcon test finds the tests, and all of them pass, the linters too."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace, expect, group, hint, solution_path
from autograder.checking.probes import colcon_test, given_files, linters, student_test_reports, student_test_runs
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import PACKAGE

check = group("step_7", doc=contract.TESTING_DOC)
LINTERS = ("test_flake8::test_flake8", "test_pep257::test_pep257")
SHOWN = 5
GIVEN = ("test/test_integration.py", "test/conftest.py")


@pytest.fixture(scope="module")
def tested(workspace: Workspace) -> student_test_reports.Report:
    """What colcon test says, once for all checks."""
    return colcon_test.colcon_test(workspace, PACKAGE)


@check(points=2, covers="pytest", needs=("build",), after=("interface_package",))
@hint("Without extras_require={'test': ['pytest']} in setup.py, colcon runs no test and ends with status 0.")
@hint("test_flake8.py, test_pep257.py and test_integration.py are in test/, too.")
def test_colcon_finds_tests(tested: student_test_reports.Report) -> None:
    """Colcon test finds the package's tests: the student's own, the integration test and both linters."""
    colcon_test.expect_ended(tested)
    ran = tested.executed
    expect(bool(ran), "colcon test ran no test at all.")
    modules = sorted({test.partition("::")[0] for test in ran})
    broken = [f" {test}: {message}" for test, message in tested.claims.messages.items() if message and test in ran]
    for name in ("test_sectors", "test_integration", "test_flake8", "test_pep257"):
        expect(
            name in modules,
            f"No test of {name}.py ran; there ran: {', '.join(modules)}.{''.join(broken[:1])}",
        )


@check(points=2, covers="linters", needs=("build",), after=("colcon_finds_tests",))
@hint("Run colcon test in a terminal, then colcon test-result --all --verbose.")
@hint("The linters name a file, a line and a rule: fix them one by one.")
def test_linters_pass(workspace: Workspace, tested: student_test_reports.Report) -> None:
    """The linters flake8 and pep257 report no errors."""
    for name in LINTERS:
        verdict = tested.claims.verdicts.get(name)
        expect(
            verdict is student_test_reports.ClaimedOutcome.PASSED,
            f"{name}: {tested.claims.messages.get(name) or 'it did not run'}",
        )
    linters.expect_tidy(workspace, student_test_runs.take(workspace, PACKAGE), LINTERS)


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
@hint("test_integration.py launches your launch file: a robot that drives while it sees, and stops when it is blind.")
def test_tests_pass(workspace: Workspace, tested: student_test_reports.Report) -> None:
    """Every test of the package passes, the one that launches the whole system, too, which is as it was given."""
    expect(any(name not in LINTERS for name in tested.executed), "colcon test ran no test but those of the linters.")
    bad = [name for name in tested.failed if name not in LINTERS]
    messages = tested.claims.messages
    shown = "; ".join(f"{name}: {messages.get(name, '')}" for name in bad[:SHOWN])
    expect(not bad, f"{len(bad)} of {len(tested.executed)} tests fail: {shown}")
    kept, solution = student_test_runs.take(workspace, PACKAGE).files, solution_path(PACKAGE)
    changed = given_files.changed_files(kept, {name: (solution / name).read_bytes() for name in GIVEN}, ("test",))
    expect(not changed, f"{' and '.join(changed)} should be as given, and was changed.", fraction=0.5)
