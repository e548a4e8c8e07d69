"""Restores the released cells of a submitted notebook before nbgrader reads it."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import nbformat
from nbformat import NotebookNode
from nbgrader.preprocessors import NbGraderPreprocessor

from autograder.author.course.forms import Form, in_form
from autograder.grade import submitted_notebook
from autograder.plain_text import clean

# Markdown and highlighting can take time proportional to the square of a cell's length. The students' cells of the
# reference solutions have 6,572 characters at most, and 21,281 in all.
MAX_CELL = 20_000  # characters of a student's cell that is rendered as usual
MAX_CELLS = 100_000  # characters of all students' cells of a notebook that are rendered as usual
MAX_FURTHER = 200  # characters of each further cell
_PLAIN = "text"  # Pygments' lexer for text without highlighting


class RestoreCells(NbGraderPreprocessor):
    """Restores nbgrader's cells from the released form of the source notebook.

    nbgrader itself restores only existing cells. It does not notice deleted, retyped or copied grade cells. After this
    step, a submission has each nbgrader cell of the source notebook exactly once, and no others.
    """

    def preprocess(self, nb: NotebookNode, resources: dict[str, Any]) -> tuple[NotebookNode, dict[str, Any]]:
        coursedir = self.parent.parent.coursedir
        names = resources["nbgrader"]
        folder = coursedir.format_path(coursedir.source_directory, ".", names["assignment"])
        source = nbformat.read(Path(folder) / f"{names['notebook']}.ipynb", as_version=4)
        return restored(nb, in_form(source, Form.RELEASED)), resources


def restored(submitted: NotebookNode, released: NotebookNode) -> NotebookNode:
    """Return the submitted notebook with the nbgrader cells of the released one.

    The student's cells lose their metadata and attachments, because pages generated from the notebook would use them.
    A very long cell of the student is cut and shown as plain text.
    """
    notebook = submitted_notebook.restore(submitted, released)
    given_counts = Counter(clean(cell.source) for cell in released.cells)
    ids: set[str] = set()
    total = 0
    for cell in notebook.cells:
        cell.source = clean(cell.source)
        if given_counts[cell.source]:  # a further copy of a given cell is the student's
            given_counts[cell.source] -= 1
        else:
            limit = MAX_CELL if total + min(len(cell.source), MAX_CELL) <= MAX_CELLS else MAX_FURTHER
            total += min(len(cell.source), limit)
            if len(cell.source) > limit:
                _cut(cell, limit)
    notebook.cells = [_as_text(cell) if cell.cell_type == "raw" else cell for cell in notebook.cells]
    for cell in notebook.cells:
        cell.pop("attachments", None)
        # A browser cannot distinguish two cells with the same id, and nbformat only warns about them.
        while cell.get("id") is None or cell.id in ids:
            cell.id = nbformat.v4.new_raw_cell().id
        ids.add(cell.id)
    return notebook


def _cut(cell: NotebookNode, limit: int) -> None:
    """Replace the source of a cell with its first `limit` characters as plain text, after a sentence that says so."""
    cell.source = (
        f"This cell has {len(cell.source):,} characters. Here are the first {limit:,}. "
        f"The submitted notebook contains all.\n\n{cell.source[:limit]}"
    )
    if cell.cell_type == "code":
        cell.metadata.magics_language = _PLAIN  # the sentence precedes any magic, which would choose another lexer
    elif cell.cell_type == "markdown":
        cell.source = _indented(cell.source)


def _as_text(cell: NotebookNode) -> NotebookNode:
    """Return a raw cell as Markdown that shows its text, which a template would otherwise treat as HTML."""
    return nbformat.v4.new_markdown_cell(_indented(cell.source), metadata=cell.metadata)


def _indented(text: str) -> str:
    """Return text as a code block in Markdown, which shows it as it is."""
    return "\n".join(f"    {line}" for line in text.split("\n"))
