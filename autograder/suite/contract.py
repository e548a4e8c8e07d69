"""The contract of a chapter: the sentences of its notebook that oblige a student, each with an id.

A sentence stands where the student reads it. The metadata of its cell name it, or a part of it, word for word; a
table's row has its bars, and a wrapped line is one line:

    {"course": {"contract": {"stale-scan": "| the newest scan arrived more than 0.5 s ago, in ROS time | 0 | 0 |",
                             "keeps-pace": "always"},
                "unchecked": {"keeps-pace": "why no check can cover it"},
                "explains": ["- a row, a bullet or a docstring that obliges to nothing"]}}

An id that stands in two cells is said twice; a list of texts is said in several sentences. A check names the ids that
it covers. Feedback quotes the whole sentence or row, as it is read (`autograder.suite.quotation`).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from autograder import layout
from autograder.suite.quotation import quote


@dataclass(frozen=True)
class Sentence:
    """A sentence that obliges a student.

    Attributes:
        id: its name in its chapter.
        text: the whole sentence, or the row of a table, as a student reads it.
        unchecked: why no check covers it. It is empty if checks do.
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
    """Return how many sentences the contracts of chapters have, and how many of them no check covers."""
    found = [sentence for name in assignments for sentence in contract(name).values()]
    return {"contract_sentences": len(found), "contract_unchecked": sum(bool(each.unchecked) for each in found)}


def sentences(cells: Iterable[Mapping[str, Any]]) -> dict[str, Sentence]:
    """Return the sentences that the metadata of a notebook's cells name. The first cell of an id counts."""
    found: dict[str, Sentence] = {}
    for cell in cells:
        course = cell["metadata"].get("course", {})
        for name, texts in course.get("contract", {}).items():
            named = [texts] if isinstance(texts, str) else texts
            whole = dict.fromkeys(quote(cell, text) or text for text in named)
            unchecked = course.get("unchecked", {}).get(name, "")
            found.setdefault(name, Sentence(name, " ".join(whole), unchecked))
    return found
