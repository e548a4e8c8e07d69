"""Prints for the command line. All output goes through `echo`, because it may contain a student's text."""

from __future__ import annotations

import click

from autograder.plain_text import visible

INTERRUPTED = 130  # the exit status of a shell after Ctrl-C


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text with control characters made visible, to standard error if `err` is set."""
    click.echo(visible(str(text)), err=err, nl=nl)


def on_line(text: object) -> str:
    """Return a text for use within a line, so that it cannot start another line."""
    return visible(str(text), line=True)
