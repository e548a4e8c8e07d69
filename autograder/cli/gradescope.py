"""`autograder gradescope`: writes the autograder that an instructor uploads to Gradescope."""

from __future__ import annotations

from pathlib import Path

import click

from autograder.cli.options import isolation_option
from autograder.cli.terminal import echo
from autograder.lms.gradescope_autograder import write_autograder
from autograder.run.sandbox import Isolation


@click.command()
@click.argument("assignment", metavar="ID")
@click.option(
    "--out",
    required=True,
    type=click.Path(path_type=Path, dir_okay=False),
    help="The zip to write. It must not exist.",
)
@isolation_option
def gradescope(assignment: str, out: Path, isolation: str) -> None:
    """Write the autograder of the assignment ID, a zip for Gradescope's page "Configure Autograder".

    It contains the hidden checks and the reference. Gradescope builds an image from it and runs it for each submission.
    """
    write_autograder(assignment, out, Isolation(isolation))
    echo(f"{out}: upload it at Gradescope, under Configure Autograder")
