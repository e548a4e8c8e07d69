"""The command line: `autograder VERB`.

Exit status: 0 success, 1 unmet requirement or error, 2 wrong usage, 130 interrupted.
"""

from __future__ import annotations

import importlib
import io
import os
import sys
import traceback
from pathlib import Path
from typing import Any

import click

from autograder import __version__
from autograder.cli.terminal import INTERRUPTED, echo
from autograder.exceptions import AutograderError, UsageError

VERBS = (
    *("check", "compare", "course", "demo", "doctor", "export", "grade", "gradescope", "new", "notebooks", "release"),
    *("replay", "ros", "serve", "similar", "update", "verify"),
)


class Verbs(click.Group):
    """The verbs. Each is a command in a module of its name, and the module is imported when the verb is called."""

    def main(self, *args: Any, **extra: Any) -> Any:
        """Run a verb, and exit. Usage errors of click are cleaned, because they may quote a student's file name."""
        try:
            status = super().main(*args, **{**extra, "standalone_mode": False})
        except click.ClickException as error:
            error.show(message := io.StringIO())
            echo(message.getvalue(), err=True, nl=False)
            status = error.exit_code
        except click.Abort:
            echo("Aborted!", err=True)
            status = INTERRUPTED
        sys.exit(status if isinstance(status, int) else 0)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the available verbs. A student release has fewer."""
        return [verb for verb in VERBS if Path(__file__).with_name(f"{verb}.py").is_file()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self.list_commands(ctx):
            return None
        command: click.Command = getattr(importlib.import_module(f"autograder.cli.{cmd_name}"), cmd_name)
        return command


def _set_course(context: click.Context, option: click.Parameter, course: Path | None) -> None:
    """Set the variable in which `autograder.course_paths` looks for the course, here and in child processes."""
    if course is not None:
        os.environ["AUTOGRADER_COURSE"] = str(course.resolve())


@click.group(cls=Verbs, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__)
@click.option(
    "--course",
    type=click.Path(path_type=Path, file_okay=False),
    expose_value=False,
    callback=_set_course,
    help="Use the course in this folder, which contains a course.yaml. AUTOGRADER_COURSE sets it for all commands.",
)
def group() -> None:
    """Check and grade ROS 2 packages that students write in Python."""


def main(arguments: list[str] | None = None) -> None:
    """Run the command line. Known errors are printed as a sentence, without a traceback."""
    try:
        group(args=arguments, prog_name="autograder")
    except AutograderError as error:
        echo(f"autograder: {error}", err=True)
        sys.exit(2 if isinstance(error, UsageError) else 1)
    except Exception:  # a bug in the grader; its message may contain a student's text
        echo(traceback.format_exc(), err=True, nl=False)
        sys.exit(1)
