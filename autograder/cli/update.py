"""`autograder update`: a later release mends a student's bundle."""

from __future__ import annotations

from pathlib import Path

import click

from autograder import layout
from autograder.bundle import mend, read_manifest
from autograder.exceptions import UsageError


@click.command()
@click.argument("release", required=False, type=click.Path(path_type=Path, file_okay=False, exists=True))
def update(release: Path | None) -> None:
    """Mend this bundle by a later one in the folder RELEASE (by default where the course keeps its newest).

    What you have written stays as it is: files and cells that you have changed, and those that you have added.
    """
    course = read_manifest(layout.ROOT).course
    if release is None and not course:
        raise UsageError("this release does not say where a newer one is: unpack it somewhere and name the folder")
    written, kept = mend(layout.ROOT, release or Path(course))
    for name in kept:
        click.echo(f"Kept as you have it: {name}")
    click.echo(f"{len(written)} files mended; this is the release of {read_manifest(layout.ROOT).version} now")
