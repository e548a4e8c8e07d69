"""`autograder release`: what students get."""

from __future__ import annotations

from pathlib import Path

import click

from autograder.author.course.release import write_bundle
from autograder.cli.options import json_option
from autograder.cli.terminal import echo
from autograder.result.model import write_json


@click.command()
@click.argument("names", nargs=-1, metavar="[ID]...")
@click.option(
    "--out", required=True, type=click.Path(path_type=Path), help="The folder to make. It must not be there yet."
)
@click.option(
    "--newest",
    default="",
    metavar="FOLDER",
    help="Where students' machines find the newest release: `autograder update` and the doctor look there.",
)
@json_option
def release(names: tuple[str, ...], out: Path, newest: str, json_file: Path | None) -> None:
    """Write the students' bundle of the chapters ID (all by default).

    The bundle holds the released notebooks, the packages that they give, the simulator, and the students' half of the
    autograder. It holds no hidden check and no solution. `autograder update` updates a student's folder to a later
    release.
    """
    written = write_bundle(out, names, newest)
    echo(f"{out}: {', '.join(written)}")
    if json_file is not None:
        write_json(json_file, {"out": str(out), "assignments": written})
