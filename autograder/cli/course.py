"""`autograder course`: keeps the notebooks and the reference solutions one text, and writes the instructors' pages."""

from __future__ import annotations

import sys

import click

from autograder import layout
from autograder.author.course.cells import is_graded
from autograder.author.course.contract_rules import broken_contract
from autograder.author.course.findings import Finding
from autograder.author.course.notebook_rules import broken_rules
from autograder.author.course.sync import Chapter, chapters, find_outdated, sync_chapter
from autograder.author.course.tables import course_page, titles
from autograder.author.course.workload import outdated_time_sentence
from autograder.author.verification.checks_page import checks_page
from autograder.cli.terminal import echo
from autograder.suite import suites

_names = click.argument("names", nargs=-1, metavar="[ID]...")


@click.group()
def course() -> None:
    """Keep the notebooks and the reference solutions the same text."""


@course.command()
@_names
def sync(names: tuple[str, ...]) -> None:
    """Write the text of the reference into notebooks, and the points of the suites into grade cells."""
    for chapter in chapters(names):
        changed = len(sync_chapter(chapter))
        echo(f"{chapter.assignment}: " + (f"{changed} brought up to date" if changed else "as it was"))


@course.command()
@_names
def check(names: tuple[str, ...]) -> None:
    """Say what is stale and which rules for notebooks are broken. If there is anything, the exit status is 1."""
    found = [finding for chapter in chapters(names) for finding in findings(chapter)]
    for finding in found:
        echo(str(finding))
    sys.exit(1 if found else 0)


def findings(chapter: Chapter) -> list[Finding]:
    """Return everything that is wrong with a chapter."""
    notebook, name = chapter.read(), chapter.notebook_path.name
    found = [*find_outdated(chapter), *broken_rules(name, notebook), *outdated_time_sentence(name, notebook)]
    if any(map(is_graded, notebook.cells)):
        hidden, visible = suites.hidden(chapter.assignment), suites.visible(chapter.assignment)
        found += broken_contract(name, notebook, (*visible.checks, *hidden.checks))
    return found


@course.command()
def tables() -> None:
    """Write the pages for instructors, and for students the titles of the checks that judge after handing in."""
    page, problems = course_page()
    for finding in problems:
        echo(str(finding))
    course = layout.course()
    pages = {layout.CHAPTERS / "README.md": page, course.root / course.guide: checks_page()}
    for path, text in {**titles(), **pages}.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
