"""`autograder verify`: the grader proves itself."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from autograder import layout, suites
from autograder.cli.grade import Progress
from autograder.cli.options import isolation_option, jobs_option, json_option, marks, seed_option, table
from autograder.grading.proof import REFERENCE, RELEASE, Claim, prove
from autograder.result import write_json
from autograder.sandbox import Tier
from autograder.suites.mutants import Mutant, mutants


@click.command()
@click.option(
    "--assignment", "assignments", multiple=True, metavar="ID", help="Only these; all graded ones by default."
)
@click.option("--quick", is_flag=True, help="Leave out the mutants that wait for a time-out.")
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=layout.BUILD / "verify")
@jobs_option
@seed_option
@isolation_option
@json_option
def verify(
    assignments: tuple[str, ...],
    quick: bool,
    out: Path,
    jobs: int,
    seed: int,
    isolation: str,
    json_file: Path | None,
) -> None:
    """Prove the grader: the reference has every point, the release none, each mutant loses what it names.

    Exit status: 0 when every claim holds, 1 otherwise.
    """

    def wanted(mutant: Mutant) -> bool:
        return not (quick and mutant.slow)

    claims: list[Claim] = []
    for assignment in assignments or tuple(suites.graded()):
        total = 2 + sum(wanted(mutant) for mutant in mutants(assignment))
        with Progress(total) as progress:
            claims += prove(
                assignment,
                seed=seed,
                out=out / assignment,
                jobs=jobs,
                isolation=Tier(isolation),
                only=wanted,
                on_result=progress.show,
            )
    click.echo("\n" + table([(c.name, marks(c.result), c.wrong or "as claimed") for c in claims], HEADINGS))
    report = {"summary": summary(claims), "claims": [{"name": c.name, "wrong": c.wrong} for c in claims]}
    for path in filter(None, (out / "verify.json", json_file)):
        write_json(path, report)
    sys.exit(0 if all(claim.holds for claim in claims) else 1)


HEADINGS = ("submission", "marks", "claim")


def summary(claims: list[Claim]) -> dict[str, object]:
    """Count what was proved."""
    flawed = [claim for claim in claims if claim.name not in (REFERENCE, RELEASE)]
    return {
        "reference": min(claim.result.percent for claim in claims if claim.name == REFERENCE),
        "release": max(claim.result.percent for claim in claims if claim.name == RELEASE),
        "mutants": len(flawed),
        "mutants_wrong": sum(not claim.holds for claim in flawed),
    }
