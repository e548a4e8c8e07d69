"""Prints the output of the command line. All of it goes through `echo`, because it may contain a student's text."""

from __future__ import annotations

import click

from autograder.plain_text import visible

INTERRUPTED = 130  # the exit status after Ctrl-C, as in a shell


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text, with escapes for control characters. If `err` is set, print it to standard error."""
    click.echo(visible(str(text)), err=err, nl=nl)


def on_line(text: object) -> str:
    """Return a text that can be printed within a line, because it cannot start another line."""
    return visible(str(text), line=True)
