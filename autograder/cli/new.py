"""`autograder new`: creates a chapter or a course as a starting point."""

from __future__ import annotations

from pathlib import Path

import click

from autograder.cli.terminal import echo


@click.group()
def new() -> None:
    """Create a chapter or a course as a starting point."""


@new.command()
@click.argument("assignment", metavar="ID")
@click.option(
    "--package", metavar="NAME", default="", help="The students' package. The default is the ID without its number."
)
@click.option(
    "--node", metavar="NAME", default="nearest", show_default=True, help="The name of its node, executable and module."
)
def chapter(assignment: str, package: str, node: str) -> None:
    """Create the chapter ID, such as 10_mapping: a small, working chapter that passes verification.

    It has a notebook with requirements, a reference, visible and hidden checks, mutants and a variant. Names that
    Python, pip or ROS uses are rejected.
    """
    from autograder.author.course.new import write_chapter

    for folder in write_chapter(assignment, package, node):
        echo(folder)
    echo(f"\nVerify it:       autograder verify --assignment {assignment}")
    echo(f"After a change:  autograder course sync {assignment}, and autograder course tables")


@new.command()
@click.argument("folder", type=click.Path(path_type=Path))
def course(folder: Path) -> None:
    """Create a course without chapters in FOLDER."""
    from autograder.author.course.new import write_course

    write_course(folder.resolve())
    echo(f"{folder}\n\nIts first chapter: autograder --course {folder} new chapter 01_first")
