"""`autograder check`: the visible checks, on a terminal."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.cli.terminal import echo
from autograder.notebook.checking import CheckReport
from autograder.notebook.checking import check as run_checks
from autograder.result.model import write_json


@click.command()
@click.argument("assignment", metavar="ID")
@click.argument("workspace", type=click.Path(path_type=Path), default=None, metavar="[PATH]")
@json_option
def check(assignment: str, workspace: Path | None, json_file: Path | None) -> None:
    """Run the visible checks of the chapter ID on the colcon workspace at PATH.

    PATH is by default the first of ./ws, ./ID/ws and ./chapters/ID/ws that exists.
    """
    report = run_checks(assignment, workspace or _workspace(assignment))
    echo(repr(report))
    if json_file is not None:
        write_json(json_file, dataclasses.asdict(report))
    sys.exit(0 if isinstance(report, CheckReport) and report.passed else 1)


def _workspace(assignment: str) -> Path:
    """Return the workspace that is checked if the command line names none."""
    here = Path("ws")
    below = (Path(assignment) / "ws", Path("chapters", assignment, "ws"))
    return next((folder for folder in (here, *below) if folder.is_dir()), here)
