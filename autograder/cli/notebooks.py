"""`autograder notebooks`: executes the course's notebooks."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from autograder import layout
from autograder.cli.options import json_option
from autograder.result import write_json


@click.command()
@click.argument("assignments", nargs=-1, metavar="[ID]...")
@click.option("--solved", "form", flag_value="solved", help="With the reference answers, as the grader sees them.")
@click.option("--released", "form", flag_value="released", help="As students get them, exercises unsolved.")
@click.option("--source", "form", flag_value="source", default="source", help="As they are in chapters/ (default).")
@json_option
def notebooks(assignments: tuple[str, ...], form: str, json_file: Path | None) -> None:
    """Execute notebooks (all of them by default), warnings as errors, one report each in .build/notebooks."""
    from autograder.course import Form, run_notebook
    from autograder.ros import activate

    activate()
    runs = []
    for name in assignments or tuple(layout.assignments()):
        report = layout.BUILD / "notebooks" / f"{name}-{form}.ipynb"
        execution = run_notebook(layout.source_notebook(name), Form(form), report=report)
        runs.append(execution)
        click.echo(f"{name} ({form}): {'ok' if execution.ok else 'failed'} in {execution.seconds:.1f} s")
        if execution.failure is not None:
            click.echo(execution.failure)
    if json_file is not None:
        write_json(
            json_file,
            [{"assignment": r.chapter, "form": form, "seconds": r.seconds, "failure": r.failure} for r in runs],
        )
    sys.exit(0 if all(execution.ok for execution in runs) else 1)
