"""Steps 4, 6 and 7: the launch file, the configuration, the tests and the linters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor

import pytest

from autograder.checking import STILL_TO_BE_WRITTEN, LaunchHarness, Workspace, check, expect, hint
from autograder.checking.probes import (
    colcon_test,
    installed,
    launch_probe,
    linters,
    parameters,
    student_test_reports,
    student_test_runs,
    versions,
)
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import (
    CONFIG,
    LAUNCH_FILE,
    PACKAGE,
    PARAMETERS,
    PROGRAMS,
    SECTORS,
    name_of,
)
from autograder.checks.ch08_capstone.support.sources import source_of

TESTS, LINTERS = ("test_sectors.py",), ("test_flake8.py", "test_pep257.py")
ON_MUTANT = ("a mutant",)
# Ignores the sector: returns the nearest of all finite readings.
ALL_AROUND = """import math

FRONT, LEFT, RIGHT = 0.0, math.pi / 2, -math.pi / 2


def nearest(scan, middle, half_angle):
    return min(reading for reading in scan.ranges if math.isfinite(reading))
"""
Reports = Mapping[tuple[str, ...], student_test_reports.Report]


@pytest.fixture(scope="module", autouse=True)
def reports(workspace: Workspace) -> Iterator[Future[Reports]]:
    """A future for the reports of the tests and linters, which run while the check of the launch file waits."""

    def run_tests() -> Reports:
        test_runs = {
            files: student_test_reports.TestRun(files)
            for files in (TESTS, LINTERS)
            if not _missing_files(workspace, files)
        }
        if TESTS in test_runs:
            version = versions.Version({f"{PACKAGE}/__init__.py": "", f"{PACKAGE}/{SECTORS}.py": ALL_AROUND}, {})
            test_runs[ON_MUTANT] = student_test_reports.TestRun(TESTS, version, exit_first=True, is_public=True)
        results = student_test_runs.run(
            workspace, student_test_runs.read_source(workspace, PACKAGE), list(test_runs.values())
        )
        return dict(zip(test_runs, results, strict=True))

    with ThreadPoolExecutor(1) as executor:
        yield executor.submit(run_tests)


@check(points=1, covers=("launches", "launch-arguments"), group="step_4", needs=("starts",), doc=contract.LAUNCH_DOC)
@hint("Node(package='robot_navigation_tutorial', executable=name, name=name, output='screen', parameters=[...])")
@hint("DeclareLaunchArgument('use_sim_time', default_value='false', description='...'), and the same for params_file.")
def test_launch(workspace: Workspace) -> None:
    """Step 4: navigation.launch.py starts the three nodes, use_sim_time reaches them, and Ctrl-C ends them."""
    file = workspace.install / PACKAGE / "share" / PACKAGE / "launch" / LAUNCH_FILE
    expect(file.is_file(), f"launch/{LAUNCH_FILE} is not installed: write it, and check data_files in setup.py.")
    with LaunchHarness(workspace, PACKAGE, LAUNCH_FILE, {"use_sim_time": "true"}) as harness:
        launch_probe.expect_nodes(harness, [name_of(name) for name in PROGRAMS])
        for name in PROGRAMS:
            launch_probe.expect_parameters(harness, name_of(name), {"use_sim_time": True})
        launch_probe.expect_clean_stop(harness)


@check(points=1, covers="config", group="step_5", needs=("package",), doc=contract.PARAMETERS_DOC)
@hint("Write a node's name, then ros__parameters, then names and values. Indent each level by two spaces.")
def test_config_file(workspace: Workspace) -> None:
    """Step 5: the installed configuration file holds every parameter of every node, with its default."""
    config = parameters.read_file(workspace.install / PACKAGE / "share" / PACKAGE / CONFIG)
    for node, bounds_by_name in PARAMETERS.items():
        values = parameters.for_node(config, node)
        missing_names = [name for name in bounds_by_name if name not in values]
        expect(not missing_names, f"{CONFIG} has no {' and no '.join(missing_names)} for {node}.")
        differences = parameters.differences(values, {name: bounds.default for name, bounds in bounds_by_name.items()})
        expect(not differences, f"{CONFIG}: {'; '.join(differences)}.")


@check(points=1, covers="sector-tests", group="step_6", needs=("package",), doc=contract.TESTING_DOC)
@hint("The cell below test_sectors.py runs it: read its last lines.")
@hint("From the package, import only robot_navigation_tutorial.sectors.")
def test_sector_tests(workspace: Workspace, reports: Future[Reports]) -> None:
    """Step 6: at least four tests in test_sectors.py run on your sectors.py, and pass."""
    expect(not _missing_files(workspace, TESTS), f"There is no test/{TESTS[0]}.")
    text = (source_of(workspace, PACKAGE) / "test" / TESTS[0]).read_text(errors="replace")
    expect(
        STILL_TO_BE_WRITTEN not in text,
        f"{TESTS[0]} is still to be written: replace the line raise NotImplementedError(...) with your tests.",
    )
    report = reports.result()[TESTS]
    messages = report.claims.messages
    failures = "; ".join(f"{name}: {messages.get(name, '')}" for name in report.failed[:3])
    expect(not report.failed, f"Failed tests ({len(report.failed)}): {failures}")
    message = f"{len(report.executed)} tests ran, instead of at least 4. {report.output.strip()[-300:]}"
    expect(len(report.executed) >= 4, message)


@check(points=1, covers="sector-tests", group="step_6", needs=("sector_tests",), doc=contract.TESTING_DOC)
@hint("Put something near on the left, and test the front sector.", "Change nearest yourself: which test fails?")
def test_sector_tests_notice(reports: Future[Reports]) -> None:
    """Step 6: at least one of the tests fails on a sectors.py in which nearest ignores the sector."""
    results = reports.result()
    expect(
        results[ON_MUTANT].detects_fault(results[TESTS]),
        "All of your tests also pass on a sectors.py in which nearest ignores the sector.",
    )


@check(points=1, covers=("linters", "pytest"), group="step_7", needs=("package",), doc=contract.TESTING_DOC)
@hint("The linters name a file, a line and a rule; `colcon test-result --all --verbose` shows all of them.")
@hint("Without extras_require={'test': ['pytest']} in setup.py, colcon runs no tests and exits with status 0.")
def test_quality(workspace: Workspace, reports: Future[Reports]) -> None:
    """Step 7: colcon test will run your tests, and flake8 and pep257 report no errors."""
    runs_pytest = colcon_test.runs_pytest(workspace, installed.inspect_package(workspace.install, PACKAGE))
    expect(runs_pytest, "setup.py does not name pytest, so `colcon test` runs no tests.")
    missing_files = _missing_files(workspace, LINTERS)
    expect(not missing_files, f"There is no test/{' and no test/'.join(missing_files)}.")
    report = reports.result()[LINTERS]
    messages = "; ".join(report.claims.messages.get(name, name) for name in report.failed)
    expect(report.passed, f"The linters report errors: {messages or report.output.strip()[-300:]}")
    executed_files = {f"{test.partition('::')[0]}.py" for test in report.executed}
    expect(
        executed_files >= set(LINTERS),
        f"All tests in {' and in '.join(sorted({*LINTERS} - executed_files))} were skipped.",
    )
    findings = linters.lint(workspace, student_test_runs.read_source(workspace, PACKAGE))
    expect(
        not findings,
        "; ".join(f"{name} passes, but its linter reports: {finding}" for name, finding in findings.items()),
    )


def _missing_files(workspace: Workspace, files: tuple[str, ...]) -> list[str]:
    """Return the test files that do not exist."""
    tests = source_of(workspace, PACKAGE) / "test"
    return [name for name in files if not (tests / name).is_file()]
