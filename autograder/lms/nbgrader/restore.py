"""Restores the released cells of a submitted notebook before nbgrader reads it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
from nbformat import NotebookNode
from nbgrader.preprocessors import NbGraderPreprocessor

from autograder.author.course.forms import Form, in_form
from autograder.grade import submitted_notebook
from autograder.plain_text import clean


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
    """
    notebook = submitted_notebook.restore(submitted, released)
    ids: set[str] = set()
    notebook.cells = [_as_text(cell) if cell.cell_type == "raw" else cell for cell in notebook.cells]
    for cell in notebook.cells:
        cell.source = clean(cell.source)
        cell.pop("attachments", None)
        # A browser cannot distinguish two cells with the same id, and nbformat only warns about them.
        while cell.get("id") is None or cell.id in ids:
            cell.id = nbformat.v4.new_raw_cell().id
        ids.add(cell.id)
    return notebook


def _as_text(cell: NotebookNode) -> NotebookNode:
    """Return a raw cell as Markdown that shows its text, which a template would otherwise treat as HTML."""
    text = "\n".join(f"    {line}" for line in clean(cell.source).split("\n"))
    return nbformat.v4.new_markdown_cell(text, metadata=cell.metadata)
