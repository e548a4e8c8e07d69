"""`autograder new`: a chapter or a course to begin with."""

from __future__ import annotations

from pathlib import Path

import click

from autograder.cli.terminal import echo


@click.group()
def new() -> None:
    """Write a chapter or a course to begin with."""


@new.command()
@click.argument("assignment", metavar="ID")
@click.option(
    "--package", metavar="NAME", default="", help="The students' package. The default is the ID without its number."
)
@click.option(
    "--node", metavar="NAME", default="nearest", show_default=True, help="Its node, its executable and their module."
)
def chapter(assignment: str, package: str, node: str) -> None:
    """Write the chapter ID, such as 10_mapping: a small one that works, and that passes the proof.

    It has a notebook with a contract, a reference, visible and hidden checks, mutants and a variant. Names that Python,
    pip or ROS uses are refused.
    """
    from autograder.author.course.new import write_chapter

    for folder in write_chapter(assignment, package, node):
        echo(folder)
    echo(f"\nProve it:        autograder verify --assignment {assignment}")
    echo(f"After a change:  autograder course sync {assignment}, and autograder course tables")


@new.command()
@click.argument("folder", type=click.Path(path_type=Path))
def course(folder: Path) -> None:
    """Write a course without chapters to FOLDER."""
    from autograder.author.course.new import write_course

    write_course(folder.resolve())
    echo(f"{folder}\n\nIts first chapter: autograder --course {folder} new chapter 01_first")
