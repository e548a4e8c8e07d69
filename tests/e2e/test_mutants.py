"""Each mutant of the reference loses the checks that it names, and no other."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder import suites
from autograder.checks import Outcome
from autograder.grading import grade_submission
from autograder.result import Status
from autograder.suites.mutants import Mutant, lay_down, mutants

ASSIGNMENTS = suites.graded()
QUICK = [(name, mutant) for name in ASSIGNMENTS for mutant in mutants(name) if not mutant.slow]
SLOW = [(name, mutant) for name in ASSIGNMENTS for mutant in mutants(name) if mutant.slow]


@pytest.mark.parametrize(
    ("assignment", "mutant"),
    [
        *(pytest.param(name, mutant, id=f"{name}-{mutant.id}") for name, mutant in QUICK),
        *(pytest.param(name, mutant, id=f"{name}-{mutant.id}", marks=pytest.mark.slow) for name, mutant in SLOW),
    ],
)
def test_a_mutant_loses_what_it_names_and_nothing_else(assignment: str, mutant: Mutant, tmp_path: Path) -> None:
    lay_down(mutant, suites.load(assignment).packages, tmp_path / "submission")
    result = grade_submission(
        tmp_path / "submission", assignment, student=mutant.id, seed=2026, out=tmp_path / "out"
    ).result
    assert result.status is Status.GRADED, (tmp_path / "out" / "grader.log").read_text()
    lost = {check.id: check.message for check in result.checks if check.outcome is not Outcome.PASSED}
    assert set(lost) == mutant.loses, lost
    assert result.diagnosis.kind is mutant.diagnosis
