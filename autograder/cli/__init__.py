"""The command line: `autograder VERB`. Exit status 0 is good, 1 falls short, 2 is a wrong call."""

from __future__ import annotations

import sys

import click

from autograder import __version__
from autograder.cli.check import check
from autograder.cli.demo import demo
from autograder.cli.doctor import doctor
from autograder.cli.export import export
from autograder.cli.grade import grade
from autograder.cli.notebooks import notebooks
from autograder.cli.verify import verify
from autograder.exceptions import AutograderError, UsageError


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__)
def group() -> None:
    """Checks and grades packages for ROS 2 Jazzy that students write in Python."""


for verb in (check, demo, doctor, export, grade, notebooks, verify):
    group.add_command(verb)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; errors that the grader knows become one sentence, not a traceback."""
    try:
        group(args=arguments, prog_name="autograder")
    except UsageError as error:
        click.echo(f"autograder: {error}", err=True)
        sys.exit(2)
    except AutograderError as error:
        click.echo(f"autograder: {error}", err=True)
        sys.exit(1)
