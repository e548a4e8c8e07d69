"""`autograder update`: updates a student's folder to a later release."""

from __future__ import annotations

from pathlib import Path

import click

from autograder import course_paths
from autograder.author.student_release import read_manifest, update_release
from autograder.cli.terminal import echo
from autograder.exceptions import UsageError


@click.command()
@click.argument("release", required=False, type=click.Path(path_type=Path, file_okay=False, exists=True))
def update(release: Path | None) -> None:
    """Update this folder to the release in the folder RELEASE (by default the course's newest).

    Your work is kept: files and cells in `chapters` that you have changed or added. If you have changed a file of the
    course elsewhere, your version is kept with the suffix `.yours`.
    """
    newest_release = read_manifest(course_paths.ROOT).course
    if release is None and not newest_release:
        raise UsageError(
            "this release does not record the folder of newer ones: unpack a newer one and give its folder"
        )
    outcome = update_release(course_paths.ROOT, release or Path(newest_release))
    for name in outcome.skipped:
        echo(f"Kept unchanged: {name}")
    for name, copy in outcome.backups.items():
        echo(f"You had changed {name}: your version is now {copy}.")
    echo(f"{len(outcome.written)} files updated. This is now the release {read_manifest(course_paths.ROOT).version}.")
