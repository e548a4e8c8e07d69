"""`autograder cluster`: what grading on many machines needs."""

from __future__ import annotations

from pathlib import Path

import click

from autograder.cli.options import certificates_option, json_option
from autograder.result import write_json


@click.group()
def cluster() -> None:
    """Prepare grading on many machines; `autograder grade --scheduler` does it."""


@cluster.command()
@certificates_option
@json_option
def certificates(certificates: Path, json_file: Path | None) -> None:
    """Make the certificate and the key by which the machines of a cluster know each other.

    Copy the folder to each machine. Who has it can read submissions and give marks.
    """
    from autograder.cluster.certificates import make

    certificate, key = make(certificates)
    tls = f"--tls-ca-file {certificate} --tls-cert {certificate} --tls-key {key}"
    click.echo(f"Copy {certificates} to each machine, and start there, in the course's folder:\n")
    click.echo(f"  .venv/bin/dask scheduler --protocol tls --preload autograder.cluster {tls}")
    click.echo(f"  .venv/bin/dask worker tls://SCHEDULER:8786 --nworkers 1 --preload autograder.cluster {tls}")
    click.echo("  .venv/bin/autograder grade ... --scheduler tls://SCHEDULER:8786")
    if json_file is not None:
        write_json(json_file, {"certificate": str(certificate), "key": str(key)})
