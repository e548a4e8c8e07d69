"""`autograder check`: the visible checks, on a terminal."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.notebook.checking import CheckReport
from autograder.notebook.checking import check as run_checks
from autograder.result import write_json


@click.command()
@click.argument("assignment", metavar="ID")
@click.argument("workspace", type=click.Path(path_type=Path), default=Path("ws"), metavar="[PATH]")
@json_option
def check(assignment: str, workspace: Path, json_file: Path | None) -> None:
    """Run the visible checks of the chapter ID on the colcon workspace at PATH (./ws by default)."""
    report = run_checks(assignment, workspace)
    click.echo(repr(report))
    if json_file is not None:
        write_json(json_file, dataclasses.asdict(report))
    sys.exit(0 if isinstance(report, CheckReport) and report.passed else 1)
