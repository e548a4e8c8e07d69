"""The proof's part for each change: the references, releases and right variants, and a third of the mutants.

The commit draws which mutants: one in three of those of `make verify --quick`, which has one for each check. So the
runs of a few commits take them all, and `make nightly` takes them all at once.
"""

from __future__ import annotations

import hashlib
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

from autograder.checks import suites
from autograder.layout import ROOT
from autograder.proof import Case, CaseKind, cases, prove
from autograder.proof.lanes import Lanes
from autograder.sandbox import Tier

SHARE = 3
PROOF = [case for name in suites.graded() for case in cases(name, quick=True)]


def commit() -> str:
    """Return the hash of the commit that is checked out, "" outside of a repository."""
    found = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
    return found.stdout.strip()


def parameters(cases: list[Case], draw: str) -> list[ParameterSet]:
    """Return the cases as parameters; those that `draw` does not choose are for the night."""
    found = []
    for case in cases:
        id = f"{case.assignment}-{case.kind.value}-{case.name}"
        number = int(hashlib.sha256(f"{draw} {id}".encode()).hexdigest(), 16)
        chosen = case.kind is not CaseKind.MUTANT or number % SHARE == 0
        found.append(pytest.param(case, id=id, marks=[] if chosen else [pytest.mark.nightly]))
    return found


def test_the_commits_draw_all_mutants_in_turn() -> None:
    drawn = [{p.id for p in parameters(PROOF, str(n)) if not p.marks} for n in range(20)]
    assert set.union(*drawn) == {p.id for p in parameters(PROOF, "")}
    assert all(len(PROOF) / 4 < len(some) < len(PROOF) * 2 / 3 for some in drawn)


@pytest.fixture(scope="session")
def lanes() -> Iterator[Lanes]:
    with Lanes(Tier.BUBBLEWRAP, 1) as lane:
        yield lane


@pytest.mark.slow
@pytest.mark.parametrize("case", parameters(PROOF, commit()))
def test_grading_makes_of_a_submission_what_is_claimed(case: Case, lanes: Lanes, tmp_path: Path) -> None:
    (claim,) = prove([case], seed=2026, out=tmp_path, lanes=lanes)
    log = tmp_path / case.assignment / case.name / "grader.log"
    messages = [f"{check.id}: {check.points:g} points. {check.message}" for check in claim.result.checks]
    details = [claim.mismatch, *messages, log.read_text() if log.is_file() else ""]
    assert claim.holds, "\n".join(details)
