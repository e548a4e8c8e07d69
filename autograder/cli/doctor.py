"""`autograder doctor`: what this machine has and lacks."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.doctor import System, examine, healthy, render, security
from autograder.doctor.finding import VERDICTS
from autograder.result import write_json


@click.command()
@click.option("--security", "escapes", is_flag=True, help="Try to get out of a sandbox, and say what held.")
@json_option
def doctor(escapes: bool, json_file: Path | None) -> None:
    """Say what this machine has, what it lacks, and the one command that mends it."""
    findings = security.examine() if escapes else examine(System())
    click.echo(render(findings, verdicts=security.VERDICTS if escapes else VERDICTS))
    if json_file is not None:
        write_json(json_file, [dataclasses.asdict(finding) for finding in findings])
    sys.exit(0 if healthy(findings) else 1)
