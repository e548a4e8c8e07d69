"""The proof's part for each change: the reference, right variants, and one mutant a check, chapter by chapter."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.checks import suites
from autograder.proof import Case, cases, prove
from autograder.proof.lanes import Lanes
from autograder.sandbox import Tier

PROOF = [case for name in suites.graded() for case in cases(name, quick=True)]


@pytest.fixture(scope="session")
def lanes() -> Iterator[Lanes]:
    with Lanes(Tier.BUBBLEWRAP, 1) as lane:
        yield lane


@pytest.mark.slow
@pytest.mark.parametrize("case", PROOF, ids=[f"{case.assignment}-{case.kind.value}-{case.name}" for case in PROOF])
def test_grading_makes_of_a_submission_what_is_claimed(case: Case, lanes: Lanes, tmp_path: Path) -> None:
    (claim,) = prove([case], seed=2026, out=tmp_path, lanes=lanes)
    log = tmp_path / case.assignment / case.name / "grader.log"
    assert claim.holds, f"{claim.wrong}\n{log.read_text() if log.is_file() else ''}"
