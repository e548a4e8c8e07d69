"""The submitted notebook gets back what a student may not change, before nbgrader trusts any of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
from nbformat import NotebookNode
from nbgrader.preprocessors import NbGraderPreprocessor

from autograder.course import Form, in_form
from autograder.feedback.text import clean
from autograder.grading import submitted_notebook


class RestoreCells(NbGraderPreprocessor):
    """Restores nbgrader's cells from the released form of the source notebook.

    nbgrader repairs the cells that are there; it trusts the marks of grade cells that were deleted, retyped or copied.
    After this step a submission has each of the source's marked cells once, and no other cell is marked.
    """

    def preprocess(self, nb: NotebookNode, resources: dict[str, Any]) -> tuple[NotebookNode, dict[str, Any]]:
        coursedir = self.parent.parent.coursedir
        marks = resources["nbgrader"]
        folder = coursedir.format_path(coursedir.source_directory, ".", marks["assignment"])
        source = nbformat.read(Path(folder) / f"{marks['notebook']}.ipynb", as_version=4)
        return restored(nb, in_form(source, Form.RELEASED)), resources


def restored(submitted: NotebookNode, released: NotebookNode) -> NotebookNode:
    """Return the submitted notebook with the released one's marked cells, and the student's cells as plain text.

    Metadata and attachments of a student's cell are dropped: pages made from the notebook would take them over.
    """
    notebook = submitted_notebook.restore(submitted, released)
    ids: set[str] = set()
    for cell in notebook.cells:
        cell.source = clean(cell.source)
        if not submitted_notebook.grade_id(cell):
            cell.metadata = NotebookNode()
        cell.pop("attachments", None)
        # Two cells of one id would be one cell to a browser; nbformat only warns.
        while cell.get("id") is None or cell.id in ids:
            cell.id = nbformat.v4.new_raw_cell().id
        ids.add(cell.id)
    return notebook
