"""`autograder release`: writes a student release."""

from __future__ import annotations

from pathlib import Path

import click

from autograder.author.course.release import write_release
from autograder.cli.options import json_option
from autograder.cli.terminal import echo
from autograder.result.model import write_json


@click.command()
@click.argument("names", nargs=-1, metavar="[ID]...")
@click.option("--out", required=True, type=click.Path(path_type=Path), help="The folder to create. It must not exist.")
@click.option(
    "--newest",
    default="",
    metavar="FOLDER",
    help="A folder on students' machines for the newest release, used by `autograder update` and the doctor.",
)
@json_option
def release(names: tuple[str, ...], out: Path, newest: str, json_file: Path | None) -> None:
    """Write a student release of the chapters ID (all by default).

    It contains the released notebooks, the packages that they provide, the simulator, and the students' part of the
    autograder. It contains no hidden checks and no solutions. `autograder update` updates a student's folder to a later
    release.
    """
    released_chapters = write_release(out, names, newest)
    echo(f"{out}: {', '.join(released_chapters)}")
    if json_file is not None:
        write_json(json_file, {"out": str(out), "assignments": released_chapters})
