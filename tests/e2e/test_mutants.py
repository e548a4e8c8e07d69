"""The proof's part for each change: the reference, right variants, and one mutant a check, chapter by chapter."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder import suites
from autograder.proof import Case, cases, prove

PROOF = [(name, case) for name in suites.graded() for case in cases(name, quick=True)]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("assignment", "case"), PROOF, ids=[f"{name}-{case.kind.value}-{case.name}" for name, case in PROOF]
)
def test_grading_makes_of_a_submission_what_is_claimed(assignment: str, case: Case, tmp_path: Path) -> None:
    (claim,) = prove(assignment, [case], seed=2026, out=tmp_path / "out", jobs=1)
    log = tmp_path / "out" / case.name / "grader.log"
    assert claim.holds, f"{claim.wrong}\n{log.read_text() if log.is_file() else ''}"
