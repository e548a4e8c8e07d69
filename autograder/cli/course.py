"""`autograder course`: keeps notebooks and solutions in sync, and writes the instructors' pages."""

from __future__ import annotations

import sys

import click

from autograder import course_paths
from autograder.author.course.chapter_rules import read_chapter, require_checks
from autograder.author.course.course_rules import course_file_findings, course_findings
from autograder.author.course.sync import chapters, sync_chapter
from autograder.author.course.tables import COURSE_PAGE, course_page, titles
from autograder.author.verification.checks_page import checks_page
from autograder.cli.terminal import echo

_names = click.argument("names", nargs=-1, metavar="[ID]...")


@click.group()
def course() -> None:
    """Keep notebooks and solutions in sync."""


@course.command()
@_names
@click.option("--dry-run", is_flag=True, help="Write nothing. List what would be updated.")
def sync(names: tuple[str, ...], dry_run: bool) -> None:
    """Copy the reference into notebooks, and the points of the suites into grade cells."""
    selected_chapters = chapters(names)
    require_checks(chapter.assignment for chapter in selected_chapters)
    for chapter in selected_chapters:
        differences = sync_chapter(chapter, write=not dry_run)
        for finding in differences if dry_run else ():
            echo(str(finding))
        state = "to update" if dry_run else "updated"
        echo(f"{chapter.assignment}: " + (f"{len(differences)} {state}" if differences else "unchanged"))


@course.command()
@_names
def check(names: tuple[str, ...]) -> None:
    """Report all problems in chapters, their checks, mutants and reference, each with its file and line.

    Nothing is graded: `autograder verify` does that. Without an ID, the whole course is checked. The exit status is 1
    if there are problems.
    """
    if not (problems := list(course_file_findings())):
        parsed_chapters = {chapter.assignment: read_chapter(chapter) for chapter in chapters(names)}
        problems = [finding for chapter in parsed_chapters.values() for finding in chapter.findings]
        problems += course_findings(parsed_chapters, whole=not names)
    for line in dict.fromkeys(map(str, problems)):
        echo(line)
    sys.exit(1 if problems else 0)


@course.command()
def tables() -> None:
    """Write the pages for instructors, and the titles of hidden checks for students."""
    require_checks(course_paths.assignments())
    page, problems = course_page()
    for finding in problems:
        echo(str(finding))
    course = course_paths.course()
    # The first page is generated, but in Git: a forge shows it to readers of `chapters/`.
    pages = {course_paths.CHAPTERS / COURSE_PAGE: page, course.root / course.guide: checks_page()}
    for path, text in {**titles(), **pages}.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
