"""`make hub`: runs a trial hub until Ctrl-C."""

from __future__ import annotations

import contextlib
import signal
import sys
from pathlib import Path
from threading import Event

import click

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.lms.hub.trial import install_release, serving


@click.command()
@click.option("--port", default=8000, show_default=True, help="The port of the hub on 127.0.0.1.")
@click.option(
    "--place",
    "folder",
    default=course_paths.ROOT / ".build" / "hub",
    type=click.Path(path_type=Path),
    help="The folder for its files.",
)
def main(port: int, folder: Path) -> None:
    """Serve a JupyterHub with three students and a teacher on this machine until Ctrl-C."""
    folder.mkdir(parents=True, exist_ok=True)
    course = folder / "course"
    if not (course / ".venv" / "bin" / "jupyterhub-singleuser").exists():
        install_release(folder)
    with serving(folder, course, port) as hub:
        click.echo(f"{hub.url} is open. Log in as {', '.join(hub.students)} (students) or {hub.teacher} (teacher);")
        click.echo(f"the password of each is {hub.password}. Ctrl-C stops the hub and removes these users.")
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        with contextlib.suppress(KeyboardInterrupt):
            Event().wait()


if __name__ == "__main__":
    try:
        main()
    except UsageError as error:
        sys.exit(f"hub: {error}")
