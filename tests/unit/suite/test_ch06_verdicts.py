"""Runs of a student's tests are explained in sentences: runs on a correct version, a hard one, and faulty ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from autograder.checks.ch06_testing.hidden.examination import BACKWARDS, BARE, REWORDED, SECOND, Examination
from autograder.checks.ch06_testing.hidden.faults import faults
from autograder.checks.ch06_testing.support.assertions import (
    describe_failure,
    expect_no_sleep,
    expect_passed,
    is_usable,
)
from autograder.checks.ch06_testing.support.contract import GIVEN_TESTS, GUARD, LIMITS, MIN_TESTS
from autograder.harness import Workspace
from autograder.probes.colcon_test import expect_ended
from autograder.probes.student_test_reports import ClaimedOutcome, Claims, Report, Source
from autograder.ros import environment
from autograder.run.sandbox import ExitReason
from autograder.suite import CheckFailed

GOOD, BAD = ClaimedOutcome.PASSED, ClaimedOutcome.FAILED


def report(
    *verdicts: ClaimedOutcome, status: int | None = None, exit_reason: ExitReason | None = None, message: str = ""
) -> Report:
    names = [f"test_limits::test_{number}" for number in range(len(verdicts))]
    messages = {name: message if verdict is BAD else "" for name, verdict in zip(names, verdicts, strict=True)}
    implied = int(BAD in verdicts) if status is None else status
    return Report(exit_reason, implied, Claims(dict(zip(names, verdicts, strict=True)), messages), 0, "")


ENOUGH = report(*[GOOD] * MIN_TESTS[LIMITS])


@pytest.mark.parametrize(
    ("run", "sentence", "usable"),
    [
        (None, "There is no test/test_limits.py in the package speed_guard.", False),
        (
            replace(report(exit_reason=ExitReason.WALL_TIME), status=None),
            "The tests in test_limits.py do not end on the package as it is.",
            False,
        ),
        (
            report(*[GOOD] * 5, BAD, message="assert 1 == 2"),
            "1 of 6 tests in test_limits.py fail on the package as it is: test_5: assert 1 == 2",
            True,
        ),
        (
            report(BAD, message="NotImplementedError: this part of the exercise is still to be written"),
            "test_limits.py is still to be written: test_0 raises NotImplementedError.",
            False,
        ),
        (
            report(*[GOOD] * GIVEN_TESTS[LIMITS], BAD, message="assert 1 == 2"),
            "1 of 5 tests in test_limits.py fail on the package as it is: test_4: assert 1 == 2",
            False,
        ),
        (report(status=5), "No test in test_limits.py ran on the package as it is.", False),
        (
            report(status=2),
            "pytest cannot run test_limits.py on the package as it is; it ended with exit status 2.",
            False,
        ),
        (
            replace(report(exit_reason=ExitReason.MEMORY), status=None),
            "The tests in test_limits.py ended on the package as it is before pytest could report results: memory.",
            False,
        ),
        (
            report(*[GOOD] * 5),
            "Only 5 of at least 6 tests in test_limits.py ran: a case of parametrize counts as one.",
            True,
        ),
    ],
    ids=["missing", "endless", "failing", "unwritten", "given", "none", "unreadable", "stopped", "few"],
)
def test_tests_that_do_not_pass_on_the_given_package_are_named_and_the_others_are_usable(
    run: Report | None, sentence: str, usable: bool
) -> None:
    assert is_usable(LIMITS, run) is usable
    with pytest.raises(CheckFailed) as excinfo:
        expect_passed(LIMITS, run)
    assert excinfo.value.message == sentence


def test_enough_passing_tests_are_usable() -> None:
    expect_passed(LIMITS, ENOUGH)
    assert is_usable(LIMITS, ENOUGH)


def test_the_tests_of_the_node_may_be_unwritten_in_their_fixtures() -> None:
    unfinished = report(BAD, message="NotImplementedError: this part of the exercise is still to be written")
    assert describe_failure(GUARD, unfinished, "here") == (
        "A part of test_guard.py or conftest.py is still to be written: test_0 raises NotImplementedError."
    )


def test_only_known_names_of_a_closed_report_are_shown() -> None:
    claims = Claims({"test_limits::test_0[secret]": BAD}, {"test_limits::test_0[secret]": "secret"})
    failed = replace(report(BAD), claims=claims)
    assert describe_failure(LIMITS, failed.closed(frozenset({"test_limits::test_0"})), "here") == (
        "test_0 in test_limits.py fails here."
    )
    assert describe_failure(LIMITS, failed.closed(frozenset()), "here") == "One test in test_limits.py fails here."


def test_a_stopped_colcon_test_is_not_reported_as_without_tests() -> None:
    with pytest.raises(CheckFailed, match=r"`colcon test` did not end within 150 s and was stopped"):
        expect_ended(report(status=None, exit_reason=ExitReason.WALL_TIME))
    expect_ended(report(status=1))


def test_a_sleep_is_named_by_file_and_line() -> None:
    with pytest.raises(CheckFailed, match=r"There is a sleep in test_a\.py, line 3\."):
        expect_no_sleep(Source("p", {"test/test_a.py": b"import time\n\ntime.sleep(1)\n", "p/a.py": b"sleep(1)"}))
    expect_no_sleep(Source("p", {"p/a.py": b"sleep(1)", "test/notes.txt": b"sleep(1)"}))


@pytest.fixture
def examination(tmp_path: Path) -> Examination:
    """An examination with prepared runs."""
    prepared = Examination(Workspace(tmp_path, environment.find(), tmp_path), 1, frozenset())
    prepared.__dict__["trial"] = {LIMITS: ENOUGH}
    prepared.__dict__["runs"] = {(LIMITS, fault.id): report(BAD) for fault in faults()} | {
        (LIMITS, name): ENOUGH for name in (SECOND, REWORDED, BARE, BACKWARDS)
    }
    return prepared


def test_tests_that_fail_on_all_faults_of_a_line_earn_its_points(examination: Examination) -> None:
    examination.expect_detection("unknown", "the promise.")
    examination.expect_passed_on_correct_versions(LIMITS)
    assert examination.endless_files() == []


def test_tests_that_fail_on_some_faults_of_a_line_earn_a_part_and_the_line_is_named(examination: Examination) -> None:
    examination.__dict__["runs"][LIMITS, "nan_is_clear"] = ENOUGH
    with pytest.raises(CheckFailed) as excinfo:
        examination.expect_detection("unknown", "the promise.")
    assert excinfo.value.fraction == 0.5
    assert excinfo.value.message == (
        "1 of 2 faulty versions pass all tests in test_limits.py, although they break this line of the contract: "
        "the promise."
    )


def test_a_test_that_also_fails_on_right_versions_earns_nothing(examination: Examination) -> None:
    examination.__dict__["trial"] = {LIMITS: report(BAD)}
    with pytest.raises(CheckFailed):
        examination.expect_detection("unknown", "the promise.")


def test_a_stopped_run_counts_as_failed_and_as_endless(examination: Examination) -> None:
    examination.__dict__["runs"][LIMITS, "nan_is_clear"] = report(exit_reason=ExitReason.WALL_TIME)
    examination.expect_detection("unknown", "the promise.")
    assert examination.endless_files() == [LIMITS]


def test_tests_that_fail_in_reverse_order_are_reported(examination: Examination) -> None:
    examination.__dict__["runs"][LIMITS, BACKWARDS] = report(BAD, message="secret").closed(frozenset())
    examination.expect_passed_on_correct_versions(LIMITS)
    with pytest.raises(CheckFailed, match=r"test_limits\.py fails when the tests run in the opposite") as excinfo:
        examination.expect_passed_on_correct_versions(LIMITS, BACKWARDS)
    assert "secret" not in excinfo.value.message
