"""`autograder verify`: grades submissions whose marks are known, and compares the results with these marks."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import click

from autograder import layout
from autograder.author.verification import costs
from autograder.author.verification.cases import cases
from autograder.author.verification.claims import CaseKind, Claim
from autograder.author.verification.mutation_run import MutantResult, run_mutants
from autograder.author.verification.population import GeneratedMutant, population
from autograder.author.verification.prove import prove
from autograder.author.verification.record import compared_again, record_failures
from autograder.author.verification.summary import summary
from autograder.author.verification.survivors import ChapterMutationResult, faults, mutant_counts, reasons, report
from autograder.author.verification.worker_pool import WorkerPool
from autograder.cli.grade import Progress
from autograder.cli.options import isolation_option, jobs_option, json_option, seed_option
from autograder.cli.terminal import echo
from autograder.cli.text_tables import score_text, table
from autograder.result.model import write_atomically, write_json
from autograder.run.sandbox import Tier
from autograder.suite import suites
from autograder.suite.contract import counts

HEADINGS = ("submission", "marks", "claim")


@click.command()
@click.option(
    "--assignment",
    "assignments",
    multiple=True,
    metavar="ID",
    help="Prove only these assignments. The default is all of them.",
)
@click.option(
    "--quick",
    is_flag=True,
    help="Grade only the reference, the release, the variants and one named mutant for each check. "
    "Use it after every change.",
)
@click.option("--only", "names", multiple=True, metavar="NAME", help="Grade only these submissions or mutants.")
@click.option(
    "--record",
    is_flag=True,
    help="Write what each graded mutant fails, and its diagnosis, to mutants.snapshot.yaml, beside mutants.yaml. "
    "Read the difference.",
)
@click.option("--mutants", "mutants_only", is_flag=True, help="Grade only the populations of mutants.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=lambda: layout.BUILD / "verify",
    help="The folder for the results.",
)
@jobs_option
@seed_option
@isolation_option
@json_option
def verify(
    assignments: tuple[str, ...],
    quick: bool,
    names: tuple[str, ...],
    record: bool,
    mutants_only: bool,
    out: Path,
    jobs: int,
    seed: int,
    isolation: str,
    json_file: Path | None,
) -> None:
    """Grade submissions whose marks are known, and compare the results with these marks.

    The reference and right answers in another style have every point. The untouched release has none. Each named
    mutant fails the check for which it was written, and what the snapshot records, and no other. No attack gains a
    point. Of the generated mutants that are not equivalent to the reference, at least 95 in 100 of each chapter and
    97 in 100 of all chapters lose a check. Every other one has a reason in survivors.yaml. A mutant with a reason
    is graded only if --only names it. A stopped run continues: a result counts as long as the checks, the grader
    and the submission are the same. The file mutants.md in the folder for the results has the tables.

    A named mutant that loses more than twice the points of its own check is listed, unless its result or its entry
    in mutants.yaml has a reason.

    The exit status is 0 when all of this is true, and 1 otherwise.
    """
    if record and quick:
        raise click.UsageError("--record needs whole gradings: leave --quick out")
    began = time.monotonic()
    chapters = assignments or tuple(suites.graded_assignments())
    proof = [] if mutants_only else [case for name in chapters for case in cases(name, quick=quick)]
    chosen = [case for case in proof if not names or case.name in names]
    populations = {} if quick or record else {name: population(name) for name in chapters}
    mutants = {
        chapter: [mutant for mutant in each.mutants if not names or mutant.id in names]
        for chapter, each in populations.items()
    }
    if not chosen and not any(mutants.values()):
        raise click.UsageError(f"the proof has no submission called {' or '.join(names)}")
    with Progress(len(chosen)) as progress, WorkerPool(Tier(isolation), jobs) as workers:

        def show(claim: Claim) -> None:
            progress.show(claim.result, _name(claim))

        claims = prove(chosen, seed=seed, out=out, workers=workers, on_claim=show)
        chapter_results = [
            _run_mutants(
                ChapterMutationResult(name, each, reasons(name, each)), mutants[name], bool(names), workers, seed, out
            )
            for name, each in populations.items()
            if mutants[name]
        ]
    if record:
        for chapter in dict.fromkeys(claim.assignment for claim in claims):
            echo(record_failures(chapter, claims), err=True)
        claims = compared_again(claims)
    echo("\n" + table([(_name(claim), score_text(claim.result), _verdict(claim)) for claim in claims], HEADINGS))
    paid = () if quick else costs.costs(claims)
    counted = summary(claims, time.monotonic() - began) | counts(chapters) | costs.counts(paid)
    echo("\n" + "  ".join(f"{name} {value}" for name, value in counted.items()))
    plain = {
        "summary": counted,
        "claims": [_plain(claim) for claim in claims],
        "mutants": mutant_counts(chapter_results),
        "costs": [vars(cost) for cost in paid],
    }
    for path in filter(None, (out / "verify.json", json_file)):
        write_json(path, plain)
    write_atomically(out / "mutants.md", f"{report(chapter_results)}\n{costs.report(paid)}".encode())
    for fault in (found := faults(chapter_results)):
        echo(fault, err=True)
    for sentence in costs.unexplained(paid):
        echo(sentence, err=True)
    sys.exit(0 if all(claim.holds for claim in claims) and not found else 1)


def _run_mutants(
    chapter: ChapterMutationResult,
    mutants: Sequence[GeneratedMutant],
    named: bool,
    workers: WorkerPool,
    seed: int,
    out: Path,
) -> ChapterMutationResult:
    """Grade the mutants of a chapter. One that may survive is graded only if it is `named`."""

    def show(result: MutantResult) -> None:
        if not result.killed:
            echo(f"{chapter.assignment} mutant {result.id} {result.killer or 'survives'}")

    kept = out / chapter.assignment / "mutants.jsonl"
    excused = {} if named else chapter.reasons
    asked = [mutant for mutant in mutants if mutant.id not in excused]
    results = run_mutants(chapter.assignment, asked, workers, seed=seed, kept=kept, on_result=show)
    survivors = tuple(MutantResult(mutant.id, "", 0.0, "") for mutant in mutants if mutant.id in excused)
    found = replace(chapter, results=results + survivors)
    killed = sum(result.killed for result in found.results)
    echo(f"{chapter.assignment}: {killed} of {len(mutants)} mutants killed, {len(found.unexplained)} without a reason")
    return found


def _name(claim: Claim) -> str:
    plain = claim.kind in (CaseKind.REFERENCE, CaseKind.RELEASE)
    return f"{claim.assignment} {claim.name}" if plain else f"{claim.assignment} {claim.kind.value} {claim.name}"


def _verdict(claim: Claim) -> str:
    return claim.mismatch or "as claimed"


def _plain(claim: Claim) -> dict[str, str]:
    return {
        "assignment": claim.assignment,
        "kind": claim.kind.value,
        "name": claim.name,
        "wrong": claim.mismatch,
    }
