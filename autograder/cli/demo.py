"""`autograder demo`: grades the reference and a few flawed submissions."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import click

from autograder import course_paths
from autograder.author.verification.mutants import mutants, write_mutant, write_reference
from autograder.cli.grade import Progress, report
from autograder.cli.options import isolation_option, jobs_option, json_option
from autograder.grade import DEFAULT_SEED
from autograder.grade.batch import grade_all
from autograder.result.model import write_json
from autograder.run.sandbox import Isolation
from autograder.suite import suites


@click.command()
@jobs_option
@isolation_option
@json_option
def demo(jobs: int, isolation: str, json_file: Path | None) -> None:
    """Grade the reference and some flawed submissions, and show why they lose marks. Results are in .build/demo.

    The exit status is 0 if only the reference gets full marks, and 1 otherwise.
    """
    out = course_paths.BUILD / "demo"
    assignment = course_paths.course().demo or suites.graded_assignments()[0]
    sources = suites.hidden(assignment).sources
    demo_mutants = [mutant for mutant in mutants(assignment) if mutant.demo]
    with tempfile.TemporaryDirectory(prefix="demo-") as folder:
        names = ["reference", *(mutant.id for mutant in demo_mutants), "empty"]
        submissions = {name: Path(folder) / name for name in names}
        write_reference(sources, submissions["reference"])
        for mutant in demo_mutants:
            write_mutant(mutant, sources, submissions[mutant.id])
        submissions["empty"].mkdir()
        with Progress(len(submissions)) as progress:
            results = grade_all(
                submissions,
                assignment,
                seed=DEFAULT_SEED,
                out=out,
                jobs=jobs,
                isolation=Isolation(isolation),
                on_result=progress.show,
            )
    write_json(out / "results.json", [result.to_json() for result in results])
    report(results, out, json_file)
    reference, *flawed_results = results
    is_expected = reference.percent == 100.0 and all(result.percent < 100.0 for result in flawed_results)
    sys.exit(0 if is_expected else 1)
