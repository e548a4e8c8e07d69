"""The verification for each change: the cases of `autograder verify --quick`.

It grades every reference, release and variant, and one mutant for each check. `make nightly` adds rewritten answers,
some generated mutants, and the complete verification.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

from autograder.author.verification.cases import Case, cases, rewritten_cases
from autograder.author.verification.generated_mutants import generated_mutants
from autograder.author.verification.mutation_run import FAILED, prepared_run
from autograder.author.verification.survivors import reasons
from autograder.author.verification.verify_cases import verify_cases
from autograder.author.verification.worker_pool import WorkerPool
from autograder.grade.job import Job
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.process import ExitReason
from autograder.run.sandbox.worker_sandbox import WorkerReport
from autograder.suite import suites


def named(test_cases: Iterable[Case], *marks: pytest.MarkDecorator) -> Iterator[ParameterSet]:
    """Yield each case as a parameter of a test, with an id."""
    for case in test_cases:
        yield pytest.param(case, id=f"{case.assignment}-{case.kind.value}-{case.name}", marks=marks)


VERIFICATION = [
    parameter
    for name in suites.graded_assignments()
    for parameter in (*named(cases(name, quick=True)), *named(rewritten_cases(name), pytest.mark.nightly))
]
# Chapters whose generated mutants were all graded, with a reason for every survivor.
SURVEYED = [name for name in suites.graded_assignments() if (suites.hidden(name).folder / "survivors.yaml").is_file()]
SAMPLE_SIZE = 4  # generated mutants of a chapter


@pytest.fixture(scope="session")
def workers() -> Iterator[WorkerPool]:
    with WorkerPool(Isolation.BUBBLEWRAP, 1) as worker:
        yield worker


@pytest.mark.promise(
    "The reference and correct answers in other styles get full marks.",
    "The untouched student release gets none.",
    "About a thousand wrong answers each fail exactly the checks that they should.",
    "The tests execute the notebooks and grade some of the submissions with a known mark.",
)
@pytest.mark.slow
@pytest.mark.parametrize("case", VERIFICATION)
def test_a_submission_gets_its_expected_result(case: Case, workers: WorkerPool, tmp_path: Path) -> None:
    (verdict,) = verify_cases([case], seed=2026, out=tmp_path, workers=workers)
    log = tmp_path / case.assignment / case.name / "grader.log"
    messages = [f"{check.id}: {check.points:g} points. {check.message}" for check in verdict.result.checks]
    details = [verdict.mismatch, *messages, log.read_text() if log.is_file() else ""]
    assert verdict.is_expected, "\n".join(details)


@pytest.mark.slow
@pytest.mark.nightly
@pytest.mark.parametrize("assignment", SURVEYED)
def test_generated_mutants_of_each_chapter_are_killed_or_have_a_reason(assignment: str, workers: WorkerPool) -> None:
    generated = generated_mutants(assignment)
    mutants = {mutant.id: mutant for mutant in generated.mutants}
    names = sorted(mutants.keys() - reasons(assignment, generated).keys())
    sample = names[:: -(-len(names) // SAMPLE_SIZE)]
    with prepared_run(assignment, workers, 2026) as run:
        results = [run.run_mutant(mutants[name]) for name in sample]
    print(*results, sep="\n")
    assert not [mutants[result.id].diff() for result in results if not result.killed]


@pytest.mark.slow
def test_a_patched_build_of_the_reference_is_graded_like_a_real_build(workers: WorkerPool) -> None:
    mutants = [mutant for mutant in generated_mutants("02_nodes").mutants if mutant.operator == "no publish"]
    with prepared_run("02_nodes", workers, 2026) as run:
        assert run.shortcuts["patched"] == {check.id for check in suites.hidden("02_nodes").checks}
        patched = [run.run_mutant(mutant).killer for mutant in mutants]
        run.shortcuts = {"patched": frozenset(), "unbuilt": frozenset()}
        assert [run.run_mutant(mutant).killer for mutant in mutants] == patched


class FailingWorkers:
    """Replaces a pool of workers. The grader fails on every submission."""

    isolation = Isolation.BUBBLEWRAP

    def __call__(self, job: Job) -> WorkerReport:
        return WorkerReport(ExitReason.EXITED, 1, "Traceback (most recent call last):\nOSError: the disk is full")


@pytest.mark.slow
def test_a_mutant_on_which_the_grader_fails_has_the_error(workers: WorkerPool, monkeypatch: pytest.MonkeyPatch) -> None:
    mutant = generated_mutants("01_package_structure").mutants[0]
    with prepared_run("01_package_structure", workers, 2026) as run:
        monkeypatch.setattr(run, "_workers", FailingWorkers())
        result = run.run_mutant(mutant)
    assert (result.killer, result.error) == (FAILED, "OSError: the disk is full")
