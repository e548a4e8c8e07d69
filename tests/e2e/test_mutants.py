"""The proof's part for each change: the references, releases and right variants, and a fifth of the mutants.

The commit draws which mutants: one in five of those of `make verify --quick`, which has one for each check. So the
runs of a few commits take them all, and `make nightly` takes them all at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

from autograder.checks import suites
from autograder.proof import Case, CaseKind, cases, prove
from autograder.proof.lanes import Lanes
from autograder.sandbox import Tier
from tests.drawn import marks

SHARE = 5
PROOF = [case for name in suites.graded() for case in cases(name, quick=True)]


def parameters(cases: list[Case], draw: str | None = None) -> list[ParameterSet]:
    """Return the cases as parameters; mutants that the draw does not choose are for the night."""
    found = []
    for case in cases:
        id = f"{case.assignment}-{case.kind.value}-{case.name}"
        found.append(pytest.param(case, id=id, marks=marks(id, SHARE if case.kind is CaseKind.MUTANT else 1, draw)))
    return found


def test_the_commits_draw_all_mutants_in_turn() -> None:
    drawn = [{p.id for p in parameters(PROOF, str(n)) if not p.marks} for n in range(40)]
    assert set.union(*drawn) == {p.id for p in parameters(PROOF, "")}
    always = sum(case.kind is not CaseKind.MUTANT for case in PROOF)
    assert all((len(PROOF) - always) / 10 < len(some) - always < (len(PROOF) - always) / 3 for some in drawn)


@pytest.fixture(scope="session")
def lanes() -> Iterator[Lanes]:
    with Lanes(Tier.BUBBLEWRAP, 1) as lane:
        yield lane


@pytest.mark.slow
@pytest.mark.parametrize("case", parameters(PROOF))
def test_grading_makes_of_a_submission_what_is_claimed(case: Case, lanes: Lanes, tmp_path: Path) -> None:
    (claim,) = prove([case], seed=2026, out=tmp_path, lanes=lanes)
    log = tmp_path / case.assignment / case.name / "grader.log"
    messages = [f"{check.id}: {check.points:g} points. {check.message}" for check in claim.result.checks]
    details = [claim.mismatch, *messages, log.read_text() if log.is_file() else ""]
    assert claim.holds, "\n".join(details)
