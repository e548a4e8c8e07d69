"""The failures of named mutants are recorded, except those of a mutant that passes its own check."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from autograder.author.verification import snapshot
from autograder.author.verification.mutants import mutants
from autograder.author.verification.record import compare_again, record_failures
from autograder.author.verification.snapshot import Record
from autograder.author.verification.verdicts import CaseKind, Verdict
from autograder.diagnosis import Diagnosis, Kind
from autograder.result.model import CheckResult, Status
from autograder.suite import Outcome, suites
from tests.conftest import MakeResult

ASSIGNMENT = "02_nodes"
CHECKS = suites.hidden(ASSIGNMENT).checks
FIRST, SECOND = mutants(ASSIGNMENT)[:2]


@pytest.fixture(autouse=True)
def snapshot_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The snapshot's file, a copy of the real one."""
    path = tmp_path / "mutants.snapshot.yaml"
    path.write_bytes(snapshot.snapshot_file(ASSIGNMENT).read_bytes())
    monkeypatch.setattr(snapshot, "snapshot_file", lambda assignment: path)
    return path


@pytest.fixture
def verdict_of(make_result: MakeResult) -> Callable[..., Verdict]:
    """Make the verdict of a mutant that failed these checks."""

    def verdict(name: str, *failed: str, status: Status = Status.GRADED) -> Verdict:
        checks = tuple(
            CheckResult.of(check, Outcome.FAILED if check.id in failed else Outcome.PASSED, "so") for check in CHECKS
        )
        return Verdict(ASSIGNMENT, CaseKind.MUTANT, name, make_result(checks=checks, status=status), "")

    return verdict


@pytest.mark.promise("With `--record`, it writes all checks that each mutant fails to `mutants.snapshot.yaml`.")
def test_grading_a_mutant_replaces_only_its_record(snapshot_file: Path, verdict_of: Callable[..., Verdict]) -> None:
    before = snapshot.recorded(ASSIGNMENT)
    other = next(check.id for check in CHECKS if check.id not in {FIRST.check, *FIRST.fails})
    summary = record_failures(ASSIGNMENT, [verdict_of(FIRST.id, FIRST.check, other)])
    assert summary == "02_nodes: 1 mutants graded, 1 records changed"
    assert snapshot.recorded(ASSIGNMENT) == before | {FIRST.id: Record(frozenset({FIRST.check, other}))}
    assert snapshot_file.read_text().startswith("# All checks that each mutant")


def test_an_unchanged_record_leaves_the_file_unchanged(snapshot_file: Path, verdict_of: Callable[..., Verdict]) -> None:
    before = snapshot_file.read_bytes()
    record_failures(ASSIGNMENT, [verdict_of(FIRST.id, *FIRST.fails)])
    assert snapshot_file.read_bytes() == before


def test_a_mutant_that_passes_its_own_check_is_not_recorded(verdict_of: Callable[..., Verdict]) -> None:
    before = snapshot.recorded(ASSIGNMENT)
    other = next(check.id for check in CHECKS if check.id != FIRST.check)
    summary = record_failures(ASSIGNMENT, [verdict_of(FIRST.id, other)])
    assert summary.endswith(f"0 records changed; not recorded, because they pass their own check: {FIRST.id}")
    assert snapshot.recorded(ASSIGNMENT) == before


def test_a_submission_that_was_not_graded_keeps_its_record(verdict_of: Callable[..., Verdict]) -> None:
    before = snapshot.recorded(ASSIGNMENT)
    record_failures(ASSIGNMENT, [verdict_of(SECOND.id, status=Status.NOT_GRADED)])
    assert snapshot.recorded(ASSIGNMENT) == before


def test_the_record_of_a_deleted_mutant_is_removed(snapshot_file: Path) -> None:
    snapshot_file.write_text(snapshot_file.read_text() + "no_such_mutant: all\n")
    record_failures(ASSIGNMENT, [])
    assert "no_such_mutant" not in snapshot_file.read_text()


def test_a_result_that_was_just_recorded_is_as_expected(verdict_of: Callable[..., Verdict]) -> None:
    other = next(check.id for check in CHECKS if check.id not in {FIRST.check, *FIRST.fails})
    verdicts = [verdict_of(FIRST.id, FIRST.check, other), verdict_of(SECOND.id, other)]
    record_failures(ASSIGNMENT, verdicts)
    first, second = compare_again(verdicts)
    assert first.mismatch == ""
    assert second.mismatch.startswith(f"passes {SECOND.check}, for which it was written")


def test_the_diagnosis_is_recorded_with_the_failures(verdict_of: Callable[..., Verdict]) -> None:
    verdict = verdict_of(FIRST.id, FIRST.check)
    stuck = replace(verdict, result=replace(verdict.result, diagnosis=Diagnosis(Kind.STUCK, "It hangs.")))
    assert compare_again([stuck])[0].mismatch.endswith("is diagnosed stuck instead of ok")
    record_failures(ASSIGNMENT, [stuck])
    assert snapshot.recorded(ASSIGNMENT)[FIRST.id] == Record(frozenset({FIRST.check}), Kind.STUCK)
    assert compare_again([stuck])[0].mismatch == ""
