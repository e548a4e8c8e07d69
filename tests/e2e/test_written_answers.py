"""Correct answers written from the notebooks alone get full marks, and the wrong ones lose points."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.author.verification.cases import Case
from autograder.author.verification.verdicts import CaseKind, verify_full_marks
from autograder.author.verification.verify_cases import verify_cases
from autograder.author.verification.worker_pool import WorkerPool
from autograder.result.model import Result
from autograder.run.sandbox import Isolation
from tests.written_answers import ASSIGNMENTS, right_answers, wrong_answers

pytestmark = [pytest.mark.slow, pytest.mark.nightly, pytest.mark.timeout(3600)]


@pytest.fixture(scope="session")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as worker:
        yield worker


def loses_points(result: Result) -> str:
    return "" if result.score < result.max_score else "it keeps full marks"


def mismatches(cases: list[Case], folder: Path, workers: WorkerPool) -> dict[str, str]:
    verdicts = verify_cases(cases, seed=2026, out=folder, workers=workers)
    return {verdict.name: verdict.mismatch for verdict in verdicts if verdict.mismatch}


@pytest.mark.parametrize("assignment", ASSIGNMENTS)
def test_right_answers_get_full_marks(assignment: str, workers: WorkerPool, tmp_path: Path) -> None:
    cases = [
        Case(assignment, CaseKind.VARIANT, answer.name, answer.write, verify_full_marks)
        for answer in right_answers(assignment)
    ]
    assert mismatches(cases, tmp_path, workers) == {}


@pytest.mark.parametrize("assignment", ASSIGNMENTS)
def test_wrong_answers_lose_points(assignment: str, workers: WorkerPool, tmp_path: Path) -> None:
    cases = [
        Case(
            assignment,
            CaseKind.MUTANT,
            answer.name,
            answer.write,
            verify_full_marks if answer.keeps_marks else loses_points,
        )
        for answer in wrong_answers(assignment)
    ]
    assert mismatches(cases, tmp_path, workers) == {}
