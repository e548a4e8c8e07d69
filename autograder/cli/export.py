"""`autograder export`: stored results in other programs' formats."""

from __future__ import annotations

import json
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.cli.terminal import echo, on_line
from autograder.exceptions import UsageError
from autograder.lms.marks import SYSTEMS, write_marks
from autograder.lms.roster import read_roster
from autograder.report import export as exporters
from autograder.result.class_folder import COLLECTION_REPORT
from autograder.result.model import write_json

_FOLDERS = " and ".join(name for name, format in exporters.FORMATS.items() if format.FOLDER)


@click.command()
@click.argument("results", type=click.Path(path_type=Path))
@click.option(
    "--format",
    "name",
    required=True,
    type=click.Choice(sorted([*exporters.FORMATS, *SYSTEMS])),
    help="The format to write.",
)
@click.option(
    "--out",
    required=True,
    type=click.Path(path_type=Path),
    help=f"The file to write. For {_FOLDERS}, it is the folder.",
)
@click.option(
    "--roster",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="For canvas and moodle: the table that the system exported, into which the marks are filled.",
)
@click.option(
    "--late-penalty",
    type=click.FloatRange(0, 100),
    default=0.0,
    metavar="PERCENT",
    help="For canvas and moodle: subtract PERCENT of its marks from a late submission.",
)
@json_option
def export(
    results: Path, name: str, out: Path, roster: Path | None, late_penalty: float, json_file: Path | None
) -> None:
    """Write stored RESULTS (a folder or a JSON file) as marks for other programs."""
    stored = exporters.load(results)
    if name in SYSTEMS:
        if roster is None:
            raise UsageError(f"--format {name} needs --roster: the table that {name.title()} exported")
        table = read_roster(roster)
        unmatched_students = write_marks(stored, name, table, out, late=_late(results), late_penalty=late_penalty)
        if unmatched_students:
            echo(f"Not in {roster}: {', '.join(map(on_line, unmatched_students))}", err=True)
        written = out
    else:
        written = exporters.write(stored, name, out)
    echo(f"{len(stored)} results: {written}")
    if json_file is not None:
        write_json(json_file, {"results": len(stored), "format": name, "written": str(written)})


def _late(results: Path) -> tuple[str, ...]:
    """Return the students whose submission was late, as `autograder grade --roster` found them."""
    file = results / COLLECTION_REPORT
    return tuple(json.loads(file.read_text(encoding="utf-8"))["late"]) if file.is_file() else ()
