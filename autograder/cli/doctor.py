"""`autograder doctor`: examines this machine."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.cli.terminal import echo
from autograder.doctor import System, examine, healthy, render, security
from autograder.doctor.finding import VERDICTS, Finding
from autograder.result.model import write_json


@click.command()
@click.option(
    "--security",
    "try_escapes",
    is_flag=True,
    help="Run programs that try to escape from a sandbox, and report which succeed.",
)
@json_option
def doctor(try_escapes: bool, json_file: Path | None) -> None:
    """Report what is installed, what is missing, and the commands that fix it."""
    findings = security.examine() if try_escapes else examine(System())
    echo(render(findings, verdicts=security.VERDICTS if try_escapes else VERDICTS))
    if json_file is not None:
        write_json(json_file, [_as_json(finding) for finding in findings])
    sys.exit(0 if healthy(findings) else 1)


def _as_json(finding: Finding) -> dict[str, str]:
    return {"name": finding.name, "status": finding.status.value, "found": finding.state, "mend": finding.fix}
