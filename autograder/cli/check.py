"""`autograder check`: runs the visible checks, and prints their results in a terminal."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.cli.terminal import echo
from autograder.notebook.checking import CheckReport, part_of
from autograder.notebook.checking import check as run_checks
from autograder.notebook.watching import watch as watch_files
from autograder.result.model import write_json


@click.command()
@click.argument("assignment", metavar="ID")
@click.argument("workspace", type=click.Path(path_type=Path), default=None, metavar="[PATH]")
@click.option("--exercise", type=int, metavar="N", help="Check exercise N of the notebook alone.")
@click.option("--step", type=int, metavar="N", help="Check step N of the notebook alone.")
@click.option("--question", type=int, metavar="N", help="Check question N of the notebook alone.")
@click.option("--fresh", is_flag=True, help="Run the checks even if nothing has changed since they were run.")
@click.option("--watch", is_flag=True, help="Check again when a file is saved, until Ctrl-C. Failed checks run first.")
@json_option
def check(
    assignment: str,
    workspace: Path | None,
    exercise: int | None,
    step: int | None,
    question: int | None,
    fresh: bool,
    watch: bool,
    json_file: Path | None,
) -> None:
    """Run the visible checks of the chapter ID on the colcon workspace at PATH.

    PATH is by default the first of ./ws, ./ID/ws and ./chapters/ID/ws that exists.
    """
    path = workspace or _workspace(assignment)

    def show(report: object) -> None:
        echo(repr(report))
        if json_file is not None and isinstance(report, CheckReport):
            write_json(json_file, dataclasses.asdict(report))

    if watch:
        watch_files(part_of(assignment, exercise, step, question), path, show)
        return
    report = run_checks(assignment, path, exercise=exercise, step=step, question=question, fresh=fresh)
    show(report)
    sys.exit(0 if isinstance(report, CheckReport) and report.passed else 1)


def _workspace(assignment: str) -> Path:
    folders = (Path("ws"), Path(assignment, "ws"), Path("chapters", assignment, "ws"))
    return next(filter(Path.is_dir, folders), folders[0])
