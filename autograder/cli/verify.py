"""`autograder verify`: grades submissions with known marks and compares the results."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import click

from autograder import course_paths
from autograder.author.course.chapter_rules import read_checks
from autograder.author.verification import costs
from autograder.author.verification.cases import cases
from autograder.author.verification.generated_mutants import GeneratedMutant, generated_mutants
from autograder.author.verification.mutation_run import MutantResult, run_mutants
from autograder.author.verification.record import compare_again, record_failures
from autograder.author.verification.summary import summary
from autograder.author.verification.survivors import ChapterMutationResult, faults, mutant_counts, reasons, report
from autograder.author.verification.verdicts import CaseKind, Verdict, failed_checks
from autograder.author.verification.verify_cases import verify_cases
from autograder.author.verification.worker_pool import WorkerPool
from autograder.cli.grade import Progress
from autograder.cli.options import isolation_option, jobs_option, json_option, seed_option
from autograder.cli.terminal import echo
from autograder.cli.text_tables import score_text, table
from autograder.result.model import Status, write_atomically, write_json
from autograder.run.sandbox import Isolation
from autograder.suite import suites
from autograder.suite.contract import counts

HEADINGS = ("submission", "marks", "verdict")


@click.command()
@click.option(
    "--assignment",
    "assignments",
    multiple=True,
    metavar="ID",
    help="Verify only these assignments. The default is all of them.",
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
    help="Write the failed checks and the diagnosis of each graded mutant to mutants.snapshot.yaml, beside "
    "mutants.yaml, and grade no generated mutants. Review the diff.",
)
@click.option("--mutants", "mutants_only", is_flag=True, help="Grade only the generated mutants.")
@click.option("--named", "named_only", is_flag=True, help="Grade everything except the generated mutants.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=lambda: course_paths.BUILD / "verify",
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
    named_only: bool,
    out: Path,
    jobs: int,
    seed: int,
    isolation: str,
    json_file: Path | None,
) -> None:
    """Grade submissions with known marks, and compare the results.

    The reference and correct answers in other styles must get every point, and the untouched student release none.
    Each named mutant must fail the check for which it was written, and otherwise exactly the checks in the snapshot.
    No attack may gain a point. Of the generated mutants that are not equivalent to the reference, at least 95 % of
    each chapter and 97 % of all chapters must fail a check. Every other one needs a reason in survivors.yaml. A mutant
    with a reason is only graded if --only names it. A named mutant that loses more than twice the points of its own
    check needs a reason, in its result or in its entry in mutants.yaml.

    An interrupted run continues: a result is reused as long as the checks, the grader and the submission are
    unchanged. The file mutants.md in the folder for the results contains the tables.

    Nothing is graded if checks, mutants or the reference have mistakes that `autograder course check` also reports.

    The exit status is 0 if all of these requirements are met, and 1 otherwise.
    """
    if record and quick:
        raise click.UsageError("--record needs complete gradings: remove --quick")
    if mutants_only and (named_only or quick or record):
        raise click.UsageError("--mutants grades only generated mutants, and the other option grades none: remove one")
    started_at = time.monotonic()
    chapters = assignments or tuple(suites.graded_assignments())
    known_assignments = {*suites.graded_assignments()}.intersection(chapters)
    if problems := [finding for name in sorted(known_assignments) for finding in read_checks(name).findings]:
        for line in dict.fromkeys(map(str, problems)):
            echo(line, err=True)
        sys.exit(1)
    all_cases = [] if mutants_only else [case for name in chapters for case in cases(name, quick=quick)]
    selected_cases = [case for case in all_cases if not names or case.name in names]
    is_without_generated = quick or record or named_only
    generated_by_chapter = {} if is_without_generated else {name: generated_mutants(name) for name in chapters}
    mutants = {
        chapter: [mutant for mutant in chapter_mutants.mutants if not names or mutant.id in names]
        for chapter, chapter_mutants in generated_by_chapter.items()
    }
    if not selected_cases and not any(mutants.values()):
        raise click.UsageError(_unknown_names(names))
    with Progress(len(selected_cases)) as progress, WorkerPool(Isolation(isolation), jobs) as workers:

        def show(verdict: Verdict) -> None:
            progress.show(verdict.result, _case_name(verdict), _marks_text(verdict))

        verdicts = verify_cases(selected_cases, seed=seed, out=out, workers=workers, on_verdict=show)
        chapter_results = [
            _run_mutants(
                ChapterMutationResult(name, chapter_mutants, reasons(name, chapter_mutants)),
                mutants[name],
                bool(names),
                workers,
                seed,
                out,
            )
            for name, chapter_mutants in generated_by_chapter.items()
            if mutants[name]
        ]
    if record:
        for chapter in dict.fromkeys(verdict.assignment for verdict in verdicts):
            echo(record_failures(chapter, verdicts), err=True)
        verdicts = compare_again(verdicts)
    rows = [(_case_name(verdict), _marks_text(verdict), verdict.mismatch or "as expected") for verdict in verdicts]
    echo("\n" + table(rows, HEADINGS))
    mutant_costs = () if quick else costs.costs(verdicts)
    figures = summary(verdicts, time.monotonic() - started_at) | counts(chapters) | costs.counts(mutant_costs)
    echo("\n" + "  ".join(f"{name} {value}" for name, value in figures.items() if value not in (None, [])))
    document = {
        "summary": figures,
        "claims": [_to_json(verdict) for verdict in verdicts],
        "mutants": mutant_counts(chapter_results),
        "costs": [vars(cost) for cost in mutant_costs],
    }
    for path in filter(None, (out / "verify.json", json_file)):
        write_json(path, document)
    write_atomically(out / "mutants.md", f"{report(chapter_results)}\n{costs.report(mutant_costs)}".encode())
    mutant_faults = [*faults(chapter_results), *costs.unexplained(mutant_costs)]
    for sentence in mutant_faults:
        echo(sentence, err=True)
    sys.exit(0 if all(verdict.is_expected for verdict in verdicts) and not mutant_faults else 1)


def _run_mutants(
    chapter: ChapterMutationResult,
    mutants: Sequence[GeneratedMutant],
    are_named: bool,
    workers: WorkerPool,
    seed: int,
    out: Path,
) -> ChapterMutationResult:
    """Grade the mutants of a chapter. Those that may survive are graded only if the user has named them."""

    def show(result: MutantResult) -> None:
        if not result.killed:
            outcome = f"{result.killer}: {result.error}" if result.error else "survives"
            echo(f"{chapter.assignment} mutant {result.id} {outcome}")

    cache = out / chapter.assignment / "mutants.jsonl"
    skipped_mutants = {} if are_named else chapter.reasons
    graded_mutants = [mutant for mutant in mutants if mutant.id not in skipped_mutants]
    results = run_mutants(chapter.assignment, graded_mutants, workers, seed=seed, cache=cache, on_result=show)
    survivors = tuple(MutantResult(mutant.id, "", 0.0, "") for mutant in mutants if mutant.id in skipped_mutants)
    completed_chapter = replace(chapter, results=results + survivors)
    killed_count = sum(result.killed for result in completed_chapter.results)
    unexplained_count = len(completed_chapter.unexplained)
    echo(f"{chapter.assignment}: {killed_count} of {len(mutants)} mutants killed, {unexplained_count} without a reason")
    return completed_chapter


def _unknown_names(names: Sequence[str]) -> str:
    if not names:
        return "these assignments have no submissions to grade"
    return (
        f"no submission is called {' or '.join(names)}: --only takes reference, release, the names of variants and "
        "attacks, and the ids of mutants"
    )


def _case_name(verdict: Verdict) -> str:
    is_unique = verdict.kind in (CaseKind.REFERENCE, CaseKind.RELEASE)
    kind = "" if is_unique else f"{verdict.kind.value} "
    return f"{verdict.assignment} {kind}{verdict.name}"


def _marks_text(verdict: Verdict) -> str:
    """Return the score of a submission, or the outcome of each check if only a part of them was run."""
    if not verdict.only or verdict.result.status is not Status.GRADED:
        return score_text(verdict.result)
    failed_ids = sorted(failed_checks(verdict.result) & {*verdict.only})
    passed_ids = sorted({*verdict.only}.difference(failed_ids))
    outcomes = (("fails", failed_ids), ("passes", passed_ids))
    return "; ".join(f"{outcome} {', '.join(ids)}" for outcome, ids in outcomes if ids)


def _to_json(verdict: Verdict) -> dict[str, str]:
    return {
        "assignment": verdict.assignment,
        "kind": verdict.kind.value,
        "name": verdict.name,
        "wrong": verdict.mismatch,
    }
