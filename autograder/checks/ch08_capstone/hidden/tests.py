"""Step 6: the student's tests of the sectors, run on a correct version of sectors.py and on faulty ones."""

from __future__ import annotations

import random
from dataclasses import dataclass

import pytest

from autograder.checking import CheckFailed, Workspace, expect, group, hint
from autograder.checking.probes import student_test_reports, student_test_runs
from autograder.checks.ch08_capstone.hidden.versions import FAULTS, Fault, correct_version, faulty_versions
from autograder.checks.ch08_capstone.support import contract
from autograder.checks.ch08_capstone.support.contract import PACKAGE
from autograder.checks.ch08_capstone.support.sources import source_of

check = group("step_6")
FILE = "test_sectors.py"
MIN_TESTS = 4


@dataclass(frozen=True)
class SectorTestReports:
    """The reports of the tests on a correct version, and on faulty ones."""

    correct: student_test_reports.Report
    faulty: tuple[tuple[Fault, student_test_reports.Report], ...]


@pytest.fixture(scope="module")
def sector_test_reports(workspace: Workspace, seed: int) -> SectorTestReports:
    """The reports of the student's tests, which run once for all checks, in a random order of the versions."""
    if not (source_of(workspace, PACKAGE) / "test" / FILE).is_file():
        raise CheckFailed(f"There is no test/{FILE} in the package {PACKAGE}.")
    draw = random.Random(f"{seed}:sectors")
    versions = [correct_version(draw), *faulty_versions(FAULTS, draw)]
    order = draw.sample(range(len(versions)), len(versions))
    source = student_test_runs.read_source(workspace, PACKAGE)
    test_runs = [student_test_reports.TestRun((FILE,), versions[i]) for i in order]  # each run has the same arguments
    reports = student_test_runs.run(workspace, source, test_runs)
    by_version = dict(zip(order, reports, strict=True))
    return SectorTestReports(by_version[0], tuple((fault, by_version[i]) for i, fault in enumerate(FAULTS, 1)))


@check(points=2, covers="sector-tests", doc=contract.TESTING_DOC)
@hint("Run pytest on test/test_sectors.py in a terminal, in the package's folder.")
@hint("From the package, import only robot_navigation_tutorial.sectors: the tests also run on other versions of it.")
def test_sector_tests_pass(sector_test_reports: SectorTestReports) -> None:
    """At least four tests of the sectors run on a correct sectors.py, and all of them pass."""
    report = sector_test_reports.correct
    if report.failed:
        raise CheckFailed(
            f"On a correct sectors.py, {student_test_reports.shown_name(report.failed[0])} in {FILE} fails."
        )
    ending = "before it wrote a report" if report.status is None else f"with exit status {report.status}"
    expect(report.passed, f"On a correct sectors.py, pytest ran no test in {FILE}: it ended {ending}.")
    message = f"Fewer than {MIN_TESTS} tests of nearest ran."
    expect(len(report.executed) >= MIN_TESTS, message, fraction=0.5)


@check(points=4, covers="sector-tests", after=("sector_tests_pass",), doc=contract.REP_117)
@hint("Test each line of the contract: nan, +inf, -inf, a phantom, an empty sector, left and right, angle_min.")
@hint("Put a reading that does not count before a wall and after it: the order of the beams must not matter.")
def test_sector_tests_find_faults(sector_test_reports: SectorTestReports) -> None:
    """The tests of the sectors fail on broken versions of sectors.py."""
    missed_faults = [
        fault.description
        for fault, report in sector_test_reports.faulty
        if not report.detects_fault(sector_test_reports.correct)
    ]
    expect(
        not missed_faults,
        f"Your tests do not detect: {'; '.join(missed_faults)}.",
        fraction=round(1.0 - len(missed_faults) / len(sector_test_reports.faulty), 2),
    )
