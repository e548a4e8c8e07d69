"""Checks of the tests' quality: they wait without sleeping, they end, and colcon runs them and the linters."""

from __future__ import annotations

from autograder.checking import Workspace, expect, group, hint
from autograder.checking.probes import colcon_test, given_files, installed, linters, student_test_reports
from autograder.checks.ch06_testing.hidden.examination import Examination
from autograder.checks.ch06_testing.hidden.faults import STYLES, version_in
from autograder.checks.ch06_testing.support import contract
from autograder.checks.ch06_testing.support.assertions import expect_no_sleep
from autograder.checks.ch06_testing.support.contract import GUARD, LAUNCH, MIN_TESTS, PACKAGE

check = group("craft")
SHARE_FOLDERS = ("launch", "config")  # folders whose files setup.py installs
GIVEN_FOLDERS = (PACKAGE, *SHARE_FOLDERS)  # folders with given files; students write test/, and may replace setup.py
LINTERS = ("test_flake8", "test_pep257")
EXTRAS = "extras_require={'test': ['pytest']} in setup.py tells colcon to use pytest, with every version of setuptools."


@check(points=1, covers="as-given", after=("limits_pass",), doc=contract.PYTEST)
@hint("The package is correct. If a test fails on it, change the test.")
@hint("To see whether a test fails, break a copy of the package. To undo a change, copy the course's file again.")
def test_as_given(workspace: Workspace, examination: Examination) -> None:
    """The given modules, launch file and configuration of the package are unchanged."""
    examination.expect_any_usable()
    reference_files = version_in(STYLES[0]).files
    texts = {name: text.encode() for name, text in reference_files.items()}
    changed_names = given_files.changed_files(examination.source.files, texts, GIVEN_FOLDERS)
    expect(not changed_names, f"Your package changes {' and '.join(changed_names)}, which must stay as given.")
    # The runs install each version without setup.py, so only this check finds files that setup.py does not install.
    installation = installed.inspect_package(workspace.install, PACKAGE)
    missing = [
        name for name in reference_files if name.split("/")[0] in SHARE_FOLDERS and installation.read(name) is None
    ]
    expect(
        not missing,
        f"Your package does not install {' and '.join(missing)} in share/{PACKAGE}. The given setup.py names the files "
        "in data_files.",
        fraction=0.5,
    )


@check(points=1, covers="no-sleep", after=("guard_pass",), doc=contract.PYTEST)
@hint(*contract.NO_SLEEP)
def test_no_sleep(examination: Examination) -> None:
    """No test waits with time.sleep."""
    examination.expect_usable(GUARD)
    expect_no_sleep(examination.source)


@check(points=1, covers="no-sleep", after=("guard_right", "launch_right"), doc=contract.PYTEST)
@hint("Each loop that waits needs a deadline. At its deadline, the test fails.")
@hint("spin_until_future_complete and wait_for_service have a timeout_sec. rclpy.spin has none.")
def test_ends(examination: Examination) -> None:
    """The tests end by themselves, even on a node that never answers."""
    for name in (GUARD, LAUNCH):
        examination.expect_usable(name)
    endless_files = examination.endless_files()
    expect(
        not endless_files,
        f"On a faulty version, the tests in {' and '.join(endless_files)} did not end and had to be stopped.",
    )


@check(points=2, covers="colcon-finds", after=("limits_pass",), doc=contract.CLI)
@hint("`colcon test-result --all --verbose` says how many tests were run. 0 tests is not a success.", EXTRAS)
def test_colcon(examination: Examination) -> None:
    """`colcon test` runs the tests of all three files."""
    examination.expect_any_usable()
    report = examination.colcon
    verdicts = report.claims.verdicts
    colcon_test.expect_ended(report)
    expect(bool(verdicts), "`colcon test` ran 0 tests.")
    files = {name.partition("::")[0] + ".py" for name in verdicts}
    missing = [name for name in MIN_TESTS if name not in files]
    expect(not missing, f"`colcon test` ran {len(verdicts)} tests, but none in {', '.join(missing)}.", fraction=0.5)


@check(points=2, covers="linters", after=("colcon",), doc=contract.CLI)
@hint("A test_depend does not run a linter: test/test_flake8.py and test/test_pep257.py do.")
@hint("A test that calls no linter, or asserts nothing, finds nothing: use the one that `ros2 pkg create` writes.")
@hint("Run `ament_flake8` and `ament_pep257` in the package's folder: they print file and line.")
def test_linters(workspace: Workspace, examination: Examination) -> None:
    """The linters flake8 and pep257 run as tests, and find nothing."""
    examination.expect_any_usable()
    verdicts = examination.colcon.claims.verdicts
    linter_verdicts = {name: verdict for name, verdict in verdicts.items() if name.partition("::")[2] in LINTERS}
    names = {
        name.partition("::")[2]
        for name, verdict in linter_verdicts.items()
        if verdict is not student_test_reports.ClaimedOutcome.SKIPPED
    }
    missing = [name for name in LINTERS if name not in names]
    expect(not missing, f"`colcon test` did not run {' and '.join(missing)}.")
    failed_linters = [
        name.partition("::")[2]
        for name, verdict in linter_verdicts.items()
        if verdict is not student_test_reports.ClaimedOutcome.PASSED
    ]
    expect(not failed_linters, f"{' and '.join(failed_linters)} found something in the package.", fraction=0.5)
    linters.expect_tidy(workspace, examination.source, linter_verdicts, fraction=0.5)
