"""`autograder demo`: the grader at work, on the reference and a handful of flawed submissions."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import click

from autograder import feedback, layout
from autograder.checks import suites
from autograder.cli.grade import Progress
from autograder.cli.options import isolation_option, jobs_option, json_option, marks, reason, seed_option, table
from autograder.grading.batch import Entry, grade_all
from autograder.proof.mutants import mutants, write_mutant, write_reference
from autograder.result import write_json
from autograder.sandbox import Tier

ASSIGNMENT = "08_capstone"
REFERENCE = "reference"


@click.command()
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=layout.BUILD / "demo",
    help="The folder for the results.",
)
@jobs_option
@seed_option
@isolation_option
@json_option
def demo(out: Path, jobs: int, seed: int, isolation: str, json_file: Path | None) -> None:
    """Grade the reference solution and flawed submissions, and show what each loses.

    The exit status is 0 when the reference has all marks and no flawed submission has, and 1 otherwise.
    """
    suite = suites.hidden(ASSIGNMENT)
    shown = [mutant for mutant in mutants(ASSIGNMENT) if mutant.demo]
    with tempfile.TemporaryDirectory(prefix="demo-") as folder:
        write_reference(suite.sources, Path(folder) / REFERENCE)
        for mutant in shown:
            write_mutant(mutant, suite.sources, Path(folder) / mutant.id)
        (Path(folder) / "empty").mkdir()
        names = [REFERENCE, *(mutant.id for mutant in shown), "empty"]
        entries = tuple(Entry(name, Path(folder) / name) for name in names)
        with Progress(len(entries)) as progress:
            results = grade_all(
                entries,
                ASSIGNMENT,
                seed=seed,
                out=out,
                jobs=jobs,
                isolation=Tier(isolation),
                on_result=progress.show,
            )
    for result in results:
        feedback.write(result, out / result.student)
    summary = feedback.write_summary(results, out)
    for path in filter(None, (out / "results.json", json_file)):
        write_json(path, [result.to_json() for result in results])
    click.echo("\n" + table([(r.student, marks(r), reason(r)) for r in results], ("submission", "marks", "why")))
    click.echo(f"\nFeedback with the robots' tracks: {summary}")
    reference, *flawed = results
    right = reference.percent == 100.0 and all(result.percent < 100.0 for result in flawed)
    sys.exit(0 if right else 1)
