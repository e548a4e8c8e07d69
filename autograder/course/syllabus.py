"""What the course has to hold, and where it holds it.

`assets/syllabus.yaml` lists the chapter's objectives, sections, examples, steps and questions, and its errors.
Notebooks say in their metadata what they hold of it:

    a cell       {"course": {"covers": ["basic_node.py"], "errata": [18, 19]}}
    a notebook   {"course": {"errata": [16],
                             "objectives": [{"objective": "nodes", "exercise": CELL, "groups": [GROUP]}]}}

A notebook's own errata are embodied in the packages that it gives; an objective names the cell with the exercise's
heading and the groups of hidden checks that judge it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import yaml
from nbformat import NotebookNode

from autograder import layout
from autograder.checks import Check
from autograder.course.cells import metadata
from autograder.course.findings import Finding

SYLLABUS = layout.ROOT / "assets" / "syllabus.yaml"
Key = TypeVar("Key", str, int)
PARTS = ("sections", "examples", "steps", "questions")
_HEADING = re.compile(r"^#{1,6} +(?!BEGIN |END )(.+)$", re.MULTILINE)


@dataclass(frozen=True)
class Syllabus:
    """The chapter's contents, each by its key.

    Attributes:
        objectives: what students are able to do afterwards.
        items: sections, examples, steps and questions.
        errata: by number, the error and what the course does instead.
    """

    objectives: dict[str, str]
    items: dict[str, str]
    errata: dict[int, tuple[str, str]]

    @classmethod
    def read(cls, path: Path = SYLLABUS) -> Syllabus:
        """Read the file."""
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        items = {key: text for part in PARTS for key, text in data[part].items()}
        return cls(data["objectives"], items, {n: (wrong, right) for n, (wrong, right) in data["errata"].items()})


@dataclass(frozen=True)
class Place:
    """Where something is: a chapter, and the heading under which its cell stands."""

    chapter: str
    heading: str


@dataclass(frozen=True)
class Row:
    """One exercise, and the objective that it serves.

    Attributes:
        objective: the objective's key.
        chapter: the assignment.
        exercise: the exercise's heading.
        checks: the hidden checks that judge it.
    """

    objective: str
    chapter: str
    exercise: str
    checks: tuple[Check, ...]


@dataclass(frozen=True)
class Coverage:
    """What notebooks hold of the syllabus: rows by objective, places by item and by erratum, and what is wrong."""

    rows: tuple[Row, ...]
    items: dict[str, list[Place]]
    errata: dict[int, list[Place]]
    findings: tuple[Finding, ...]


def coverage(syllabus: Syllabus, chapters: Sequence[tuple[str, NotebookNode, Sequence[Check]]]) -> Coverage:
    """Collect what the chapters hold; each is its name, its source notebook and its hidden checks."""
    rows: list[Row] = []
    items: dict[str, list[Place]] = {key: [] for key in syllabus.items}
    errata: dict[int, list[Place]] = {number: [] for number in syllabus.errata}
    findings: list[Finding] = []
    for name, notebook, checks in chapters:
        for cell, place, course in _places(name, notebook):
            for key, held in [(k, items) for k in course.get("covers", [])] + [
                (n, errata) for n in course.get("errata", [])
            ]:
                if key not in held:
                    findings.append(Finding(f"{name}.ipynb", cell, f"the syllabus has no {key!r}"))
                elif place not in held[key]:
                    held[key].append(place)
        made, wrong = _rows(name, notebook, checks, syllabus)
        rows += made
        findings += wrong
    served = {row.objective for row in rows if row.checks}
    findings += [
        Finding("assets/syllabus.yaml", None, f"no {what} holds {key!r}: {text}")
        for what, missing in (
            ("hidden check", {k: t for k, t in syllabus.objectives.items() if k not in served}),
            ("notebook", {k: t for k, t in syllabus.items.items() if not items[k]}),
            ("notebook", {n: wrong for n, (wrong, _) in syllabus.errata.items() if not errata[n]}),
        )
        for key, text in missing.items()
    ]
    return Coverage(tuple(rows), items, errata, tuple(findings))


def _note(held: dict[Key, list[Place]], keys: Sequence[Key], place: Place) -> list[Key]:
    """Note the place under each key, once; return the keys that are unknown."""
    for key in keys:
        if key in held and place not in held[key]:
            held[key].append(place)
    return [key for key in keys if key not in held]


def _places(name: str, notebook: NotebookNode) -> Iterator[tuple[str | None, Place, Any]]:
    """Yield the notebook itself and each of its cells, with the heading that it stands under."""
    title = next((found[1] for cell in notebook.cells if (found := _HEADING.search(cell.source))), name)
    yield None, Place(name, title), metadata(notebook)
    heading = title
    for cell in notebook.cells:
        if cell.cell_type == "markdown" and (found := _HEADING.search(cell.source)):
            heading = found[1]
        yield cell.id, Place(name, heading), metadata(cell)


def _rows(
    name: str, notebook: NotebookNode, checks: Sequence[Check], syllabus: Syllabus
) -> tuple[list[Row], list[Finding]]:
    rows, findings = [], []
    headings = {cell: place.heading for cell, place, _ in _places(name, notebook)}
    groups = {check.group for check in checks}
    told: set[str] = set()
    for entry in metadata(notebook).get("objectives", []):
        objective, exercise, named = entry["objective"], entry["exercise"], set(entry["groups"])
        told |= named
        for wrong, what in (
            (objective not in syllabus.objectives, f"the syllabus has no objective {objective!r}"),
            (exercise not in headings, f"there is no cell {exercise!r}"),
            (not named <= groups, f"the suite has no group {', '.join(sorted(named - groups))}"),
        ):
            if wrong:
                findings.append(Finding(f"{name}.ipynb", None, what))
        judged = tuple(check for check in checks if check.group in named)
        rows.append(Row(objective, name, headings.get(exercise, exercise), judged))
    if groups - told:
        message = f"no objective names the groups {', '.join(sorted(groups - told))}"
        findings.append(Finding(f"{name}.ipynb", None, message))
    return rows, findings
