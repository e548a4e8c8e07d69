"""`autograder verify`: the grader proves itself."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import click

from autograder import layout
from autograder.checks import suites
from autograder.checks.contract import counts
from autograder.cli.grade import Progress
from autograder.cli.options import isolation_option, jobs_option, json_option, marks, seed_option, table
from autograder.proof.cases import cases
from autograder.proof.claims import CaseKind, Claim
from autograder.proof.lanes import Lanes
from autograder.proof.prove import prove
from autograder.proof.summary import holds, summary
from autograder.result import write_json
from autograder.sandbox import Tier

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
    help="Take one mutant for each check, no generated mutants and no attacks. This is for every change.",
)
@click.option("--only", "names", multiple=True, metavar="NAME", help="Grade only these submissions of the proof.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=layout.BUILD / "verify",
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
    out: Path,
    jobs: int,
    seed: int,
    isolation: str,
    json_file: Path | None,
) -> None:
    """Prove the grader by submissions whose mark is known.

    The reference and right answers in another style have every point. The untouched release has none. Each named
    mutant loses the checks that it names, and no other. Of the generated mutants, nine in ten lose a point. No attack
    gains a point.

    The exit status is 0 when all of this holds, and 1 otherwise.
    """
    began = time.monotonic()
    proof = [case for name in assignments or suites.graded() for case in cases(name, quick=quick)]
    chosen = [case for case in proof if not names or case.name in names]
    if not chosen:
        raise click.UsageError(f"the proof has no submission called {' or '.join(names)}")
    with Progress(len(chosen)) as progress, Lanes(Tier(isolation), jobs) as lanes:

        def show(claim: Claim) -> None:
            progress.show(claim.result, _name(claim))

        claims = prove(chosen, seed=seed, out=out, lanes=lanes, on_claim=show)
    click.echo("\n" + table([(_name(claim), marks(claim.result), _verdict(claim)) for claim in claims], HEADINGS))
    counted = summary(claims, time.monotonic() - began) | counts(assignments or suites.graded())
    click.echo("\n" + "  ".join(f"{name} {value}" for name, value in counted.items()))
    report = {"summary": counted, "claims": [_plain(claim) for claim in claims]}
    for path in filter(None, (out / "verify.json", json_file)):
        write_json(path, report)
    sys.exit(0 if holds(claims) else 1)


def _name(claim: Claim) -> str:
    plain = claim.kind in (CaseKind.REFERENCE, CaseKind.RELEASE)
    return f"{claim.assignment} {claim.name}" if plain else f"{claim.assignment} {claim.kind.value} {claim.name}"


def _verdict(claim: Claim) -> str:
    if claim.holds:
        return "as claimed"
    return f"{claim.mismatch} ({claim.reason})" if claim.reason else claim.mismatch


def _plain(claim: Claim) -> dict[str, str]:
    return {
        "assignment": claim.assignment,
        "kind": claim.kind.value,
        "name": claim.name,
        "wrong": claim.mismatch,
        "reason": claim.reason,
    }
