"""`autograder similar`: finds the submissions of a class that are similar to each other."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from autograder import layout
from autograder.author.course.release import write_bundle
from autograder.cli.options import json_option
from autograder.cli.terminal import echo, on_line
from autograder.exceptions import StudentError, UsageError
from autograder.grade.apart import code, read_code
from autograder.grade.batch import discover
from autograder.result.model import write_json
from autograder.run.sandbox import Tier
from autograder.submission.intake import read_submission


@click.command()
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--assignment", required=True, metavar="ID", help="The assignment that the submissions answer.")
@click.option("--out", required=True, type=click.Path(path_type=Path, file_okay=False), help="The folder for the page.")
@click.option(
    "--least",
    type=click.FloatRange(0, 100),
    default=50.0,
    show_default=True,
    metavar="PERCENT",
    help="List a pair if at least PERCENT of the own text of one student is also in the other's.",
)
@json_option
def similar(paths: tuple[Path, ...], assignment: str, out: Path, least: float, json_file: Path | None) -> None:
    """List pairs of submissions at PATHS with similar passages. Text of the release does not count.

    A pair is a hint to read both texts, and no verdict. No mark changes.
    """
    try:
        from autograder.lms.similar import MAX_PAIRS, pairs, write_pairs
    except ModuleNotFoundError as error:
        if error.name != "copydetect":
            raise
        raise UsageError("this needs copydetect: run `.venv/bin/pip install copydetect`") from None

    def in_part(student: str, what: str) -> None:
        echo(f"Compared in part: {on_line(student)}: {what}", err=True)

    codes = {}
    with tempfile.TemporaryDirectory() as name:
        write_bundle(Path(name) / "given", (assignment,))
        given = code(read_submission(Path(name) / "given" / layout.course().chapters / assignment, assignment))
    for student, path in discover(paths, assignment).submissions.items():
        try:
            codes[student] = read_code(path, assignment, Tier.BUBBLEWRAP)
        except StudentError as error:
            echo(f"Not compared: {on_line(student)}: {on_line(error)}", err=True)
    found = pairs(codes, given, least / 100, in_part)
    for pair in found:
        shares = " and ".join(f"{100 * share:.0f} %" for share in pair.shares)
        echo(f"{on_line(pair.names[0])} and {on_line(pair.names[1])}: {shares} of their own text alike")
    if len(found) == MAX_PAIRS:
        echo(f"These are the {MAX_PAIRS} most alike. There may be more.")
    echo(f"{len(found)} pairs to read, no verdict: {write_pairs(found, out)}")
    if json_file is not None:
        write_json(json_file, [{"students": pair.names, "shares": pair.shares} for pair in found])
