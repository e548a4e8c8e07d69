"""The references get full marks with any seed: three in each run, and 97 more in `make nightly`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.author.verification.cases import Case, cases
from autograder.author.verification.verdicts import CaseKind
from autograder.author.verification.verify_cases import verify_cases
from autograder.author.verification.worker_pool import WorkerPool
from autograder.run.sandbox import Isolation
from autograder.suite import suites

EVERY_RUN = (1, 77, 424242)
NIGHTLY = tuple(range(1000, 1097))


@pytest.fixture(scope="session")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as worker:
        yield worker


def reference(assignment: str) -> Case:
    return next(case for case in cases(assignment, quick=True) if case.kind is CaseKind.REFERENCE)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*EVERY_RUN, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in NIGHTLY)])
@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_the_reference_gets_full_marks_with_any_seed(
    assignment: str, seed: int, workers: WorkerPool, tmp_path: Path
) -> None:
    (verdict,) = verify_cases([reference(assignment)], seed=seed, out=tmp_path, workers=workers)
    assert verdict.is_expected, verdict.mismatch
