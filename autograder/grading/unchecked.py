"""Results in which no check was run: the grader failed, or intake refused the submission."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime, timezone

from autograder.checks import Outcome
from autograder.checks.suites import Suite
from autograder.diagnosis import Diagnosis, Kind
from autograder.result import Build, CheckResult, Result, Status
from autograder.sandbox import Tier

LOG = "grader.log"


def not_graded(suite: Suite, student: str, seed: int, isolation: Tier, why: str) -> Result:
    """Return the result of a submission on which the grader failed: `why` says what failed. It is no zero."""
    sentence = (
        f"{why} This is no zero: an instructor has to grade it again. {LOG}, beside the result, says what happened."
    )
    result = refused(suite, student, seed, isolation, Diagnosis(Kind.NOT_GRADED, sentence))
    checks = tuple(replace(check, message="not graded") for check in result.checks)
    return replace(result, status=Status.NOT_GRADED, checks=checks, build=None, phases={})


def refused(suite: Suite, student: str, seed: int, isolation: Tier, diagnosis: Diagnosis) -> Result:
    """Return the result of a submission that intake refused, with the reason, as a worker would record it."""
    message = f"not checked: {diagnosis.sentence}"
    return Result(
        assignment=suite.assignment,
        student=student,
        submission_sha256="0" * 64,
        suite_version=suite.version,
        seed=seed,
        isolation=isolation.value,
        checks=tuple(CheckResult.of(check, Outcome.NOT_CHECKED, message) for check in suite.checks),
        max_score=suite.max_score,
        started=datetime.now(timezone.utc).isoformat(timespec="seconds"),
        seconds=0.0,
        diagnosis=diagnosis,
        build=Build(False, 0.0, log=diagnosis.detail),
        phases={"intake": 0.0},
    )
