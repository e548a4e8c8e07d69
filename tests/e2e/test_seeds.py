"""The references have every point with any seed: three here, fifty in `make nightly`."""

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

EACH_TIME = (1, 77, 424242)
AT_NIGHT = tuple(range(1000, 1047))


@pytest.fixture(scope="session")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as worker:
        yield worker


def reference(assignment: str) -> Case:
    return next(case for case in cases(assignment, quick=True) if case.kind is CaseKind.REFERENCE)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*EACH_TIME, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in AT_NIGHT)])
@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_the_reference_has_every_point(assignment: str, seed: int, workers: WorkerPool, tmp_path: Path) -> None:
    (verdict,) = verify_cases([reference(assignment)], seed=seed, out=tmp_path, workers=workers)
    assert verdict.is_expected, verdict.mismatch
