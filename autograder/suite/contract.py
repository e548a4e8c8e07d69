"""The contract of a chapter: the requirements that its notebook states, each with an id.

A requirement is written where the student reads it. The metadata of its cell quote it, or a part of it, word for word.
A row of a table is quoted with its bars, and a sentence on several lines as one line:

    {"course": {"contract": {"stale-scan": "| the newest scan arrived more than 0.5 s ago, in ROS time | 0 | 0 |",
                             "keeps-pace": "always"},
                "unchecked": {"keeps-pace": "why no check can cover it"},
                "explains": ["- a row, a bullet or a docstring that requires nothing"]}}

If two cells use the same id, they state the same requirement. A list of texts is a requirement that consists of several
sentences. A check names the ids that it covers. Feedback quotes the whole sentence or row, as it looks on the page
(`autograder.suite.quotation`).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from autograder import course_paths
from autograder.suite.quotation import quote


@dataclass(frozen=True)
class Requirement:
    """A requirement of a chapter.

    Attributes:
        id: its name in the chapter.
        text: the whole sentence, or the row of a table, as a student reads it.
        unchecked: why no check covers it; empty if one does.
    """

    id: str
    text: str
    unchecked: str = ""


def contract(assignment: str) -> dict[str, Requirement]:
    """Return a chapter's requirements by their ids, in the order of the cells.

    Raises:
        UsageError: the chapter does not exist.
    """
    notebook = json.loads(course_paths.source_notebook(assignment).read_text(encoding="utf-8"))
    return requirements(notebook["cells"])


def counts(assignments: Iterable[str]) -> dict[str, int]:
    """Count the requirements of some chapters, and those that no check covers."""
    all_requirements = [requirement for name in assignments for requirement in contract(name).values()]
    unchecked = sum(bool(requirement.unchecked) for requirement in all_requirements)
    return {"contract_sentences": len(all_requirements), "contract_unchecked": unchecked}


def requirements(cells: Iterable[Mapping[str, Any]]) -> dict[str, Requirement]:
    """Return the requirements in the metadata of a notebook's cells. If two cells use the same id, the first counts."""
    by_id: dict[str, Requirement] = {}
    for cell in cells:
        course = cell["metadata"].get("course", {})
        for name, texts in course.get("contract", {}).items():
            parts = [texts] if isinstance(texts, str) else texts
            quotations = dict.fromkeys(quote(cell, text) or text for text in parts)
            unchecked = course.get("unchecked", {}).get(name, "")
            by_id.setdefault(name, Requirement(name, " ".join(quotations), unchecked))
    return by_id
