"""The summary of a verification, and the conditions for its success."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest

from autograder.author.verification.cases import cases
from autograder.author.verification.mutants import mutants
from autograder.author.verification.summary import summary
from autograder.author.verification.verdicts import CaseKind, Verdict, verify_full_marks, verify_mutant, verify_zero
from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.result.model import CheckResult, Result
from autograder.suite import Outcome, suites

ASSIGNMENT = "02_nodes"
SUITE = suites.hidden(ASSIGNMENT)


def result(*failed: str) -> Result:
    """Return a result in which these checks failed and all others passed."""
    checks = tuple(
        CheckResult.of(
            check, Outcome.FAILED if check.id in failed else Outcome.PASSED, "so" if check.id in failed else ""
        )
        for check in SUITE.checks
    )
    return Result(
        assignment=ASSIGNMENT,
        student="x",
        submission_sha256="0" * 64,
        suite_version=SUITE.version,
        seed=1,
        isolation="bubblewrap",
        checks=checks,
        max_score=SUITE.max_score,
        started="2026-01-01T00:00:00+00:00",
        seconds=1.0,
        diagnosis=OK,
        build=None,
        artifacts=(),
        phases={},
    )


def verdict(kind: CaseKind, mismatch: str = "", *failed: str) -> Verdict:
    return Verdict(ASSIGNMENT, kind, "x", result(*failed), mismatch)


def test_a_correct_answer_has_every_point() -> None:
    assert verify_full_marks(result()) == ""
    assert verify_full_marks(result("nan")) == "fails nan: so"


def test_an_untouched_release_gains_no_points() -> None:
    assert verify_zero(result(*(check.id for check in SUITE.checks))) == ""
    assert verify_zero(result("nan")).startswith("it scores")


@pytest.mark.promise("a release that does not build is not as expected")
def test_a_release_that_students_cannot_begin_with_is_not_as_expected() -> None:
    without_points = result(*(check.id for check in SUITE.checks))
    unbuilt = replace(without_points, diagnosis=Diagnosis(Kind.BUILD_FAILED, "setup.py fails."))
    assert verify_zero(unbuilt) == "students get it broken: setup.py fails."
    assert verify_zero(replace(unbuilt, assignment="01_package_structure")) == ""  # its students correct a build
    unreadable = replace(
        without_points, assignment="01_package_structure", diagnosis=Diagnosis(Kind.NOTEBOOK_FAILED, "It ends.")
    )
    assert verify_zero(unreadable) == "students get it broken: It ends."
    unfinished = replace(without_points, diagnosis=Diagnosis(Kind.UNFINISHED, "A part is still to be written."))
    assert verify_zero(unfinished) == ""


@pytest.mark.promise("Without `--record`, the exit status is 1 if a mutant passes the check that should catch it")
def test_a_mutant_fails_its_own_check_and_exactly_the_recorded_ones() -> None:
    mutant = next(m for m in mutants(ASSIGNMENT) if m.id == "minus_inf_dropped")
    assert verify_mutant(mutant, result(*mutant.fails)) == ""
    wrong = verify_mutant(mutant, result("nan"))
    assert wrong.startswith(f"passes {mutant.check}, for which it was written; also fails nan; passes ")
    assert "`autograder verify --record`" in wrong
    unrecorded = replace(mutant, fails=frozenset())
    assert verify_mutant(unrecorded, result(*mutant.fails)) == (
        "has no recorded failures: "
        "`autograder verify --assignment 02_nodes --only minus_inf_dropped --record` writes them"
    )


def test_the_summary_counts_each_kind() -> None:
    verdicts = [
        verdict(CaseKind.REFERENCE),
        verdict(CaseKind.RELEASE, "", *(check.id for check in SUITE.checks)),
        verdict(CaseKind.VARIANT),
        verdict(CaseKind.MUTANT, "", "nan"),
        verdict(CaseKind.MUTANT, "also loses blind", "nan", "blind"),
        verdict(CaseKind.MUTANT, "keeps nan"),
        verdict(CaseKind.ATTACK, "gains nan"),
    ]
    assert summary(verdicts, 12.34) == {
        "reference": 100.0,
        "release": 0.0,
        "variants": [100.0],
        "mutants": 3,
        "mutants_missed": 1,
        "mutants_wrong_check": 1,
        "attacks": 1,
        "attacks_gained": 1,
        "seconds": 12.3,
    }


@pytest.mark.promise(
    "`autograder verify --assignment 02_nodes` grades the reference, the untouched student release,",
    "`make verify` grades all of these submissions.",
)
def test_the_cases_contain_every_kind_and_each_submission_once() -> None:
    chosen = cases(ASSIGNMENT)
    assert {case.kind for case in chosen} >= set(CaseKind) - {CaseKind.VARIANT}
    assert len({case.name for case in chosen}) == len(chosen)


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_the_quick_mutants_fail_every_check(assignment: str) -> None:
    names = {case.name for case in cases(assignment, quick=True)}
    covered = {name for mutant in mutants(assignment) if mutant.id in names for name in mutant.fails}
    assert covered == {check.id for check in suites.hidden(assignment).checks}


@pytest.mark.promise("have to fail each check")
@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_each_check_has_three_mutants(assignment: str) -> None:
    failed = Counter(name for mutant in mutants(assignment) for name in mutant.fails)
    assert [check.id for check in suites.hidden(assignment).checks if failed[check.id] < 3] == []
