"""Options that several verbs share."""

from __future__ import annotations

import os
from pathlib import Path

import click

from autograder.grade import DEFAULT_SEED
from autograder.run.sandbox import Isolation

json_option = click.option(
    "--json", "json_file", type=click.Path(path_type=Path, dir_okay=False), help="Also write the results as JSON."
)
jobs_option = click.option(
    "-j",
    "--jobs",
    type=click.IntRange(1, 64),
    default=os.cpu_count() or 1,
    show_default=True,
    help="The number of workers.",
)
seed_option = click.option(
    "--seed",
    type=click.IntRange(0, 2**31 - 1),
    default=DEFAULT_SEED,
    show_default=True,
    help="The seed of the hidden inputs.",
)
isolation_option = click.option(
    "--isolation",
    type=click.Choice([isolation.value for isolation in Isolation]),
    default=Isolation.BUBBLEWRAP.value,
    show_default=True,
    help="The isolation level of submissions. Use `process` only for code that you trust.",
)
