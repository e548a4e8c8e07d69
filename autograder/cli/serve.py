"""`autograder serve`: grades submissions on a JupyterHub immediately."""

from __future__ import annotations

import logging
import os
from pathlib import Path

import click

from autograder.cli.options import isolation_option, seed_option
from autograder.cli.terminal import echo
from autograder.exceptions import UsageError
from autograder.lms.serve.grading import GradingOptions
from autograder.lms.serve.settings import read_settings
from autograder.run.sandbox import Isolation


@click.command()
@click.argument("settings", type=click.Path(path_type=Path, dir_okay=False))
@click.option(
    "--data",
    required=True,
    type=click.Path(path_type=Path, file_okay=False),
    help="The folder for submissions and their results. Other users cannot read it.",
)
@click.option("-j", "--jobs", type=click.IntRange(1, 64), default=1, show_default=True, help="The number of workers.")
@click.option("--check", is_flag=True, help="Read and print the settings, and exit.")
@seed_option
@isolation_option
def serve(settings: Path, data: Path, jobs: int, check: bool, seed: int, isolation: str) -> None:
    """Grade submissions as a service of a JupyterHub, configured by the file SETTINGS.

    The hub starts it: docs/serve.md has the lines for its configuration. It can be stopped or
    killed at any time without losing a submission.
    """
    service_settings = read_settings(settings)
    if check:
        for name, rules in service_settings.assignments.items():
            due = f"due at {rules.due:%Y-%m-%d %H:%M %Z}" if rules.due is not None else "never due"
            counted = "best" if rules.best_counts else "last"
            echo(f"{name}: {due}, {rules.tries_a_day} tries a day, shows {rules.shown.value}, the {counted} one counts")
        return
    try:
        from autograder.lms.serve import service
    except ModuleNotFoundError as error:
        if error.name != "jupyterhub":
            raise
        raise UsageError("serve needs JupyterHub, which is not installed here: run `make hub-setup`") from None
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s")
    service.serve(service_settings, data, GradingOptions(jobs, seed, Isolation(isolation)), service.address(os.environ))
