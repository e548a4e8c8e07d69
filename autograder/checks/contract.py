"""The contract of a chapter: the sentences of its notebook that oblige a student, each with an id.

A sentence stands where the student reads it. The metadata of its cell name it, word for word; a table's row has its
bars, and a wrapped line is one line:

    {"course": {"contract": {"stale-scan": "| the newest scan arrived more than 0.5 s ago, in ROS time | 0 | 0 |",
                             "keeps-pace": "always"},
                "unchecked": {"keeps-pace": "why no check can hold it"},
                "explains": ["- a row, a bullet or a docstring that obliges to nothing"]}}

An id that stands in two cells, or has a list of texts, is said twice. A check names the ids that it holds.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from autograder import layout


@dataclass(frozen=True)
class Sentence:
    """A sentence that obliges a student.

    Attributes:
        id: its name in its chapter.
        text: the sentence, as plain text.
        unchecked: why no check holds it. It is empty if checks do.
    """

    id: str
    text: str
    unchecked: str = ""


def contract(assignment: str) -> dict[str, Sentence]:
    """Return the sentences of a chapter's contract by their ids, cell by cell.

    Raises:
        UsageError: there is no such chapter.
    """
    notebook = json.loads(layout.source_notebook(assignment).read_text(encoding="utf-8"))
    return sentences(notebook["cells"])


def counts(assignments: Iterable[str]) -> dict[str, int]:
    """Return how many sentences the contracts of chapters have, and how many of them no check holds."""
    found = [sentence for name in assignments for sentence in contract(name).values()]
    return {"contract_sentences": len(found), "contract_unchecked": sum(bool(each.unchecked) for each in found)}


def sentences(cells: Iterable[Mapping[str, Any]]) -> dict[str, Sentence]:
    """Return the sentences that the metadata of a notebook's cells name. The first place of an id counts."""
    found: dict[str, Sentence] = {}
    for cell in cells:
        course = cell["metadata"].get("course", {})
        for name, texts in course.get("contract", {}).items():
            text = texts if isinstance(texts, str) else texts[0]
            plain = _row(text, "".join(cell["source"])) if text.startswith("|") else text.removeprefix("- ")
            unchecked = course.get("unchecked", {}).get(name, "")
            found.setdefault(name, Sentence(name, plain.replace("`", "").replace("**", ""), unchecked))
    return found


def _row(row: str, source: str) -> str:
    """Return a table's row as text. The columns after the second are named by the table's head."""
    head: list[str] = []
    for line in source.splitlines():
        head = [] if not line.startswith("|") else head or _columns(line)
        if line.strip() == row:
            break
    first, *others = _columns(row)
    if len(others) > 1:
        others = [f"{name} {value}" for name, value in zip(head[1:], others, strict=False)]
    said = ", ".join(others)
    return f"{first}: {said}" if first else said


def _columns(line: str) -> list[str]:
    return [column.strip() for column in line.strip().strip("|").split("|")]
