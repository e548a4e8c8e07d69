"""Assertions on runs of a student's tests, and descriptions of failed runs for the student."""

from __future__ import annotations

from autograder.checking import CheckFailed, expect
from autograder.checking.probes import student_test_reports
from autograder.checks.ch06_testing.support.contract import GIVEN_TESTS, LIMITS, MIN_TESTS, PACKAGE
from autograder.checks.ch06_testing.support.sleeping import sleeps

UNFINISHED = "still to be written"
MAX_FAILED = 50  # the largest number of failed tests with which a file is still used


def is_usable(name: str, report: student_test_reports.Report | None) -> bool:
    """Return whether more tests of a file than the given ones pass on a correct version.

    Only then can the file tell correct and faulty versions apart.
    """
    if report is None or report.status not in (0, 1) or len(report.failed) > MAX_FAILED:
        return False
    return len(set(report.executed) - set(report.failed)) > GIVEN_TESTS[name]


def expect_passed(name: str, report: student_test_reports.Report | None) -> None:
    """Fail the check unless a file has enough tests, and all pass on the package as it is."""
    if report is None:
        raise CheckFailed(f"There is no test/{name} in the package {PACKAGE}.")
    if not report.passed:
        raise CheckFailed(describe_failure(name, report, "on the package as it is"))
    count = len(report.executed)
    expect(
        count >= MIN_TESTS[name],
        f"Only {count} of at least {MIN_TESTS[name]} tests in {name} ran: a case of parametrize counts as one.",
        fraction=0.5,
    )


def expect_no_sleep(source: student_test_reports.Source) -> None:
    """Fail the check if a test file sleeps."""
    python_files = {name: data for name, data in sorted(source.tests.items()) if name.endswith(".py")}
    sleep_lines = [f"{name}, line {line}" for name, data in python_files.items() for line in sleeps(data, name)]
    expect(not sleep_lines, f"There is a sleep in {'; '.join(sleep_lines[:3])}.")


def describe_failure(name: str, report: student_test_reports.Report, where: str) -> str:
    """Describe why a run that should have passed did not.

    Args:
        name: the test file.
        report: the report of its run. Messages of tests are quoted only if the report is not closed.
        where: the version or the circumstances, such as "on the package as it is".
    """
    if report.timed_out:
        return f"The tests in {name} do not end {where}."
    if report.failed:
        test = student_test_reports.shown_name(report.failed[0])
        if report.source_tests is not None:
            return f"{test if test != student_test_reports.UNNAMED else 'One test'} in {name} fails {where}."
        message = report.claims.messages[report.failed[0]]
        if UNFINISHED in message:
            files = name if name == LIMITS else f"A part of {name} or conftest.py"
            return f"{files} is still to be written: {test} raises NotImplementedError."
        count = f"{len(report.failed)} of {len(report.claims.verdicts)} tests in {name} fail"
        return f"{count} {where}: {test}{f': {message}' if message else ''}"
    if report.status in (0, 5):
        return f"No test in {name} ran {where}."
    if report.status is None:
        reason = report.exit_reason.value.replace("_", " ") if report.exit_reason else "no report"
        return f"The tests in {name} ended {where} before pytest could report results: {reason}."
    return f"pytest cannot run {name} {where}; it ended with exit status {report.status}."
