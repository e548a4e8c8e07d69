"""Writes the instructors' page: where the course covers the syllabus, and which checks test it.

It also writes the titles of an assignment's hidden checks, which `check(...)` shows to students when all visible checks
have passed. A title describes a requirement and reveals no input.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from autograder import course_paths
from autograder.author.course.findings import Finding
from autograder.author.course.markdown_table import table
from autograder.author.course.syllabus import Location, Syllabus, SyllabusCoverage, find_coverage
from autograder.author.course.sync import chapters
from autograder.author.course.workload import (
    FLUENT_WORDS_A_MINUTE,
    MINUTES_A_CELL,
    MINUTES_A_LINE,
    WORDS_A_MINUTE,
    Effort,
    duration_text,
    effort,
)
from autograder.suite import suites

HEAD = """# The course, chapter by chapter

One notebook an assignment; its folder is what students get. `autograder course tables` writes this page from the
notebooks' metadata, the hidden checks and `{syllabus}`; a test holds it.
"""


def course_page() -> tuple[str, tuple[Finding, ...]]:
    """Return the instructors' page of the course, and the problems in its notebooks and syllabus."""
    syllabus, have_suites = Syllabus.read(), suites.graded_assignments()
    notebooks = {chapter.assignment: chapter.read() for chapter in chapters()}
    covered = find_coverage(
        syllabus,
        [(name, book, suites.hidden(name).checks if name in have_suites else ()) for name, book in notebooks.items()],
    )
    efforts = {name: effort(book) for name, book in notebooks.items()}
    titles = {name: book.cells[0].source.splitlines()[0].removeprefix("# ") for name, book in notebooks.items()}
    return page(syllabus, covered, titles, efforts), covered.findings


def page(syllabus: Syllabus, covered: SyllabusCoverage, titles: dict[str, str], efforts: dict[str, Effort]) -> str:
    """Return the instructors' page as Markdown. Titles and efforts are given by chapter, in order."""
    points = {name: _points(covered, name) for name in titles}
    return "\n".join(
        [
            HEAD.format(syllabus=course_paths.course().syllabus),
            "## Chapters\n",
            *table(
                (
                    *("chapter", "title", "points", "words", "code cells", "lines to write", "time of a beginner"),
                    "minutes at one go",
                ),
                [
                    (f"[{n}]({n}/{n}.ipynb)", t, f"{points[n]:g}" if points[n] else "", *_effort(efforts[n]))
                    for n, t in titles.items()
                ],
            ),
            f"The time is counted: a minute for {WORDS_A_MINUTE:g} words, {MINUTES_A_CELL:g} minute for a code cell, "
            f"{MINUTES_A_LINE:g} minutes for a line to write. *At one go* is the longest time "
            f"before a cell to write or between two, for a reader of {FLUENT_WORDS_A_MINUTE:g} words a minute.\n",
            "## Objectives\n",
            *table(("objective", "chapter", "exercise", "hidden checks"), _objectives(syllabus, covered)),
            "## The chapter's contents\n",
            *table(
                ("what", "where"),
                [(syllabus.items[key], _where(locations)) for key, locations in covered.items.items()],
            ),
            "## What the chapter gets wrong\n",
            *table(
                ("#", "the chapter", "here", "where"),
                [(str(n), *syllabus.errata[n], _where(locations)) for n, locations in covered.errata.items()],
            ),
        ]
    )


def _effort(needed: Effort) -> tuple[str, ...]:
    counted = (str(needed.words), str(needed.cells), str(needed.lines), duration_text(needed.reading + needed.writing))
    return *counted, f"{needed.longest_reading:.1f}"


def _points(covered: SyllabusCoverage, name: str) -> float:
    """Return a chapter's points. A check for two objectives counts once."""
    checks = {check.id: check.points for row in covered.rows if row.chapter == name for check in row.checks}
    return sum(checks.values())


def _objectives(syllabus: Syllabus, covered: SyllabusCoverage) -> Iterator[tuple[str, ...]]:
    for key, text in syllabus.objectives.items():
        for row in covered.rows:
            if row.objective == key:
                checks = ", ".join(f"`{check.id}`" for check in row.checks)
                yield text, row.chapter, row.exercise, checks


def _where(locations: Sequence[Location]) -> str:
    return "; ".join(f"{location.chapter}: {location.heading}" for location in locations)


def titles() -> dict[Path, str]:
    """Return the text of each assignment's file with titles for students, by path."""
    return {
        course_paths.hidden_titles(name): titles_of(name)
        for name in sorted({*suites.checkable_assignments()} & {*suites.graded_assignments()})
    }


def titles_of(assignment: str) -> str:
    """Return the text of an assignment's file of titles for students."""
    visible_titles = {check.title for check in suites.visible(assignment).checks}
    hidden = [check.title for check in suites.hidden(assignment).checks if check.title not in visible_titles]
    return json.dumps(hidden, indent=1, ensure_ascii=False) + "\n"
