"""The syllabus, and the cells and hidden checks of the course that cover it.

A syllabus is a YAML file. It lists the objectives, sections, examples, steps, questions and errors of a textbook. The
metadata of a cell name the items that it covers (`covers`) and the `errata` that it corrects. The metadata of a
notebook name the errata that its packages correct. For each objective, they also name the cell with the exercise's
heading and the groups of hidden checks that test it (`objectives`).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nbformat import NotebookNode

from autograder import course_paths
from autograder.author.course.cells import metadata
from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Finding
from autograder.author.course.yaml_files import load_yaml
from autograder.suite import Check

PARTS = ("sections", "examples", "steps", "questions")
_HEADING = re.compile(r"^#{1,6} +(?!BEGIN |END )(.+)$", re.MULTILINE)


@dataclass(frozen=True)
class Syllabus:
    """The contents of the textbook chapter, by key.

    `items` are sections, examples, steps and questions. `errata` are pairs of an error and its correction.
    """

    objectives: dict[str, str]
    items: dict[str, str]
    errata: dict[int, tuple[str, str]]

    @classmethod
    def read(cls, path: Path | None = None) -> Syllabus:
        """Read a YAML file, by default the course's. Raises CourseError with all of its problems."""
        path = path or course_paths.course().root / course_paths.course().syllabus
        if not path.is_file():
            raise CourseError(f"{path}: is missing: it names the objectives of the course")
        data = load_yaml(path, schema="syllabus.yaml")
        items = {key: text for part in PARTS for key, text in (data.get(part) or {}).items()}
        errata = (data.get("errata") or {}).items()
        return cls(data["objectives"] or {}, items, {n: (wrong, right) for n, (wrong, right) in errata})


@dataclass(frozen=True)
class Location:
    """A chapter, and the heading above a cell of its notebook."""

    chapter: str
    heading: str


@dataclass(frozen=True)
class ExerciseRow:
    """The key of an objective, the heading of an exercise for it, and the hidden checks that test it."""

    objective: str
    chapter: str
    exercise: str
    checks: tuple[Check, ...]


@dataclass(frozen=True)
class SyllabusCoverage:
    """The parts of the syllabus that notebooks cover: exercises, and the locations of each item and erratum.

    The findings list syllabus entries that nothing covers, and keys that the syllabus does not contain.
    """

    rows: tuple[ExerciseRow, ...]
    items: dict[str, list[Location]]
    errata: dict[int, list[Location]]
    findings: tuple[Finding, ...]


def find_coverage(
    syllabus: Syllabus, chapters: Sequence[tuple[str, NotebookNode, Sequence[Check]]]
) -> SyllabusCoverage:
    """Find what the chapters cover. Each chapter is a tuple of its name, its source notebook and its hidden checks."""
    rows: list[ExerciseRow] = []
    items: dict[str, list[Location]] = {key: [] for key in syllabus.items}
    errata: dict[int, list[Location]] = {number: [] for number in syllabus.errata}
    findings: list[Finding] = []
    for name, notebook, checks in chapters:
        for cell, location, course in _locations(name, notebook):
            for key, locations_by_key in [(k, items) for k in course.get("covers", [])] + [
                (n, errata) for n in course.get("errata", [])
            ]:
                if key not in locations_by_key:
                    findings.append(Finding(f"{name}.ipynb", cell, f"the syllabus has no {key!r}"))
                elif location not in locations_by_key[key]:
                    locations_by_key[key].append(location)
        chapter_rows, problems = _rows(name, notebook, checks, syllabus)
        rows += chapter_rows
        findings += problems
    tested_objectives = {row.objective for row in rows if row.checks}
    findings += [
        Finding(course_paths.course().syllabus, None, f"no {kind} covers {key!r}: {text}")
        for kind, uncovered in (
            ("hidden check", {k: t for k, t in syllabus.objectives.items() if k not in tested_objectives}),
            ("notebook", {k: t for k, t in syllabus.items.items() if not items[k]}),
            ("notebook", {n: wrong for n, (wrong, _) in syllabus.errata.items() if not errata[n]}),
        )
        for key, text in uncovered.items()
    ]
    return SyllabusCoverage(tuple(rows), items, errata, tuple(findings))


def _locations(name: str, notebook: NotebookNode) -> Iterator[tuple[str | None, Location, Any]]:
    """Yield (cell id, location, course metadata) for the notebook, with the id None, and for each cell."""
    title = next((match[1] for cell in notebook.cells if (match := _HEADING.search(cell.source))), name)
    yield None, Location(name, title), metadata(notebook)
    heading = title
    for cell in notebook.cells:
        if cell.cell_type == "markdown" and (match := _HEADING.search(cell.source)):
            heading = match[1]
        yield cell.id, Location(name, heading), metadata(cell)


def _rows(
    name: str, notebook: NotebookNode, checks: Sequence[Check], syllabus: Syllabus
) -> tuple[list[ExerciseRow], list[Finding]]:
    rows, findings = [], []
    headings = {cell: location.heading for cell, location, _ in _locations(name, notebook)}
    groups = {check.group for check in checks}
    named_groups: set[str] = set()
    for entry in metadata(notebook).get("objectives", []):
        objective, exercise, entry_groups = entry["objective"], entry["exercise"], set(entry["groups"])
        named_groups |= entry_groups
        for is_wrong, message in (
            (objective not in syllabus.objectives, f"the syllabus has no objective {objective!r}"),
            (exercise not in headings, f"the notebook has no cell {exercise!r}"),
            (not entry_groups <= groups, f"the suite has no group {', '.join(sorted(entry_groups - groups))}"),
        ):
            if is_wrong:
                findings.append(Finding(f"{name}.ipynb", None, message))
        tested_by = tuple(check for check in checks if check.group in entry_groups)
        rows.append(ExerciseRow(objective, name, headings.get(exercise, exercise), tested_by))
    if groups - named_groups:
        message = f"no objective names the groups {', '.join(sorted(groups - named_groups))}"
        findings.append(Finding(f"{name}.ipynb", None, message))
    return rows, findings
