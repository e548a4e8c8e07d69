"""Prints for the command line. All of it goes through `echo`, because what is printed may hold a student's text."""

from __future__ import annotations

import click

from autograder.plain_text import visible


def echo(text: object = "", *, err: bool = False, nl: bool = True) -> None:
    """Print a text, with what would steer the terminal made visible; with `err`, to standard error."""
    click.echo(visible(str(text)), err=err, nl=nl)


def on_line(text: object) -> str:
    """Return a name or a sentence that is printed within a line, so that it cannot begin another."""
    return visible(str(text), line=True)
