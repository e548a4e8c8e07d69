"""Writes a page for instructors that shows where the course covers the syllabus and which checks test it.

It also writes the titles of an assignment's hidden checks to a file. `check(...)` shows them to students when all
visible checks have passed. A title describes a requirement and reveals no input.
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

COURSE_PAGE = "README.md"  # in the folder of the chapters
HEAD = """# The course, chapter by chapter

One notebook an assignment; its folder is what students get. `autograder course tables` writes this page from the
notebooks' metadata, the hidden checks and `{syllabus}`.
"""


def course_page() -> tuple[str, tuple[Finding, ...]]:
    """Return the page for instructors, and the problems in the course's notebooks and syllabus."""
    syllabus, graded_assignments = Syllabus.read(), suites.graded_assignments()
    notebooks = {chapter.assignment: chapter.read() for chapter in chapters()}
    coverage = find_coverage(
        syllabus,
        [
            (name, notebook, suites.hidden(name).checks if name in graded_assignments else ())
            for name, notebook in notebooks.items()
        ],
    )
    efforts = {name: effort(notebook) for name, notebook in notebooks.items()}
    titles = {name: notebook.cells[0].source.splitlines()[0].removeprefix("# ") for name, notebook in notebooks.items()}
    return page(syllabus, coverage, titles, efforts), coverage.findings


def page(syllabus: Syllabus, coverage: SyllabusCoverage, titles: dict[str, str], efforts: dict[str, Effort]) -> str:
    """Return the page for instructors as Markdown. The keys of `titles` and `efforts` are the chapters, in order."""
    points = {name: _chapter_points(coverage, name) for name in titles}
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
                    (
                        f"[{name}]({name}/{name}.ipynb)",
                        title,
                        f"{points[name]:g}" if points[name] else "",
                        *_effort_cells(efforts[name]),
                    )
                    for name, title in titles.items()
                ],
            ),
            f"The time is counted: a minute for {WORDS_A_MINUTE:g} words, {MINUTES_A_CELL:g} minute for a code cell, "
            f"{MINUTES_A_LINE:g} minutes for a line to write. *At one go* is the longest time "
            f"before a cell to write or between two, for a reader of {FLUENT_WORDS_A_MINUTE:g} words a minute.\n",
            "## Objectives\n",
            *table(("objective", "chapter", "exercise", "hidden checks"), _objective_rows(syllabus, coverage)),
            "## The chapter's contents\n",
            *table(
                ("what", "where"),
                [(syllabus.items[key], _location_text(locations)) for key, locations in coverage.items.items()],
            ),
            "## What the chapter gets wrong\n",
            *table(
                ("#", "the chapter", "here", "where"),
                [
                    (str(number), *syllabus.errata[number], _location_text(locations))
                    for number, locations in coverage.errata.items()
                ],
            ),
        ]
    )


def _effort_cells(work: Effort) -> tuple[str, ...]:
    cells = (str(work.words), str(work.cells), str(work.lines), duration_text(work.reading + work.writing))
    return *cells, f"{work.longest_reading:.1f}"


def _chapter_points(coverage: SyllabusCoverage, name: str) -> float:
    """Return a chapter's points. A check that tests two objectives counts once."""
    checks = {check.id: check.points for row in coverage.rows if row.chapter == name for check in row.checks}
    return sum(checks.values())


def _objective_rows(syllabus: Syllabus, coverage: SyllabusCoverage) -> Iterator[tuple[str, ...]]:
    for key, text in syllabus.objectives.items():
        for row in coverage.rows:
            if row.objective == key:
                checks = ", ".join(f"`{check.id}`" for check in row.checks)
                yield text, row.chapter, row.exercise, checks


def _location_text(locations: Sequence[Location]) -> str:
    return "; ".join(f"{location.chapter}: {location.heading}" for location in locations)


def titles() -> dict[Path, str]:
    """Return the path and the text of each file that lists the titles of an assignment's hidden checks."""
    return {
        course_paths.hidden_titles(name): titles_of(name)
        for name in sorted({*suites.checkable_assignments()} & {*suites.graded_assignments()})
    }


def titles_of(assignment: str) -> str:
    """Return the titles of an assignment's hidden checks as JSON, except titles that a visible check shares."""
    visible_titles = {check.title for check in suites.visible(assignment).checks}
    hidden_titles = [check.title for check in suites.hidden(assignment).checks if check.title not in visible_titles]
    return json.dumps(hidden_titles, indent=1, ensure_ascii=False) + "\n"
