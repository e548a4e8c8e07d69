"""`autograder doctor`: what this machine has and lacks."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.doctor import System, examine, healthy, render
from autograder.result import write_json


@click.command()
@json_option
def doctor(json_file: Path | None) -> None:
    """Say what this machine has, what it lacks, and the one command that mends it."""
    findings = examine(System())
    click.echo(render(findings))
    if json_file is not None:
        write_json(json_file, [dataclasses.asdict(finding) for finding in findings])
    sys.exit(0 if healthy(findings) else 1)
