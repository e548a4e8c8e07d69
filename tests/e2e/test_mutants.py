"""The proof's part for each change: some references, releases, variants and mutants.

`autograder verify --quick` has one mutant for each check. The commit draws one in 40 of them, a third of the
references, a ninth of the releases, an 18th of the variants, and eight mutants of one chapter's population. The runs of
many commits take them all, and so does `make nightly`.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from autograder.checks import suites
from autograder.proof.cases import Case, cases, rewritten_cases
from autograder.proof.claims import CaseKind
from autograder.proof.mutation_run import prepared_run
from autograder.proof.population import population
from autograder.proof.prove import prove
from autograder.proof.survivors import reasons
from autograder.proof.worker_pool import WorkerPool
from autograder.sandbox import Tier
from tests.sampling import commit, sample, unless

PROOF = {
    f"{case.assignment}-{case.kind.value}-{case.name}": case
    for name in suites.graded_assignments()
    for case in (*cases(name, quick=True), *rewritten_cases(name))
}
# Chapters of which the whole population was graded, and every survivor has a reason.
SURVEYED = [name for name in suites.graded_assignments() if (suites.hidden(name).folder / "survivors.yaml").is_file()]
PART = 8  # mutants of a chapter's population for a commit
# Of how many submissions of a kind the commit draws one.
ONE_IN = {CaseKind.REFERENCE: 3, CaseKind.RELEASE: 9, CaseKind.VARIANT: 18, CaseKind.MUTANT: 40}


def chosen(draw: str | None = None) -> set[str]:
    """Return the ids of the cases that run for each change."""
    of_kinds = ((one_in, [id for id, case in PROOF.items() if case.kind is kind]) for kind, one_in in ONE_IN.items())
    return set().union(*(sample(ids, one_in, draw) for one_in, ids in of_kinds))


def test_the_samples_of_many_commits_contain_all_cases() -> None:
    draws = [chosen(str(number)) for number in range(800)]
    assert set.union(*draws) == set(PROOF)
    assert len({len(draw) for draw in draws}) == 1
    assert len(draws[0]) < len(PROOF) / 5


@pytest.fixture(scope="session")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Tier.BUBBLEWRAP, 1) as worker:
        yield worker


@pytest.mark.slow
@pytest.mark.parametrize(
    "case", [pytest.param(PROOF[id], id=id, marks=unless(id in now)) for now in [chosen()] for id in PROOF]
)
def test_a_submission_gets_its_expected_result(case: Case, workers: WorkerPool, tmp_path: Path) -> None:
    (claim,) = prove([case], seed=2026, out=tmp_path, workers=workers)
    log = tmp_path / case.assignment / case.name / "grader.log"
    messages = [f"{check.id}: {check.points:g} points. {check.message}" for check in claim.result.checks]
    details = [claim.mismatch, *messages, log.read_text() if log.is_file() else ""]
    assert claim.holds, "\n".join(details)


@pytest.mark.slow
@pytest.mark.parametrize(
    "assignment", [pytest.param(name, marks=unless(name in now)) for now in [sample(SURVEYED, 9)] for name in SURVEYED]
)
def test_each_sampled_mutant_of_the_population_is_killed_or_has_a_reason(assignment: str, workers: WorkerPool) -> None:
    found = population(assignment)
    mutants = {mutant.id: mutant for mutant in found.mutants}
    chosen = sample(mutants, -(-len(mutants) // PART), commit()) - reasons(assignment, found).keys()
    with prepared_run(assignment, workers, 2026) as run:
        results = [run.run_mutant(mutants[name]) for name in sorted(chosen)]
    print(*results, sep="\n")
    assert not [mutants[result.id].diff() for result in results if not result.killed]


@pytest.mark.slow
def test_a_patched_build_of_the_reference_is_graded_like_a_real_build(workers: WorkerPool) -> None:
    found = [mutant for mutant in population("02_nodes").mutants if mutant.operator == "no publish"]
    with prepared_run("02_nodes", workers, 2026) as run:
        assert run.ways["patched"] == {check.id for check in suites.hidden("02_nodes").checks}
        patched = [run.run_mutant(mutant).killer for mutant in found]
        run.ways = {"patched": frozenset(), "unbuilt": frozenset()}
        assert [run.run_mutant(mutant).killer for mutant in found] == patched
