"""Notebook hygiene: a submitted notebook gets back what a student may not change.

Locked cells are restored from the source notebook, deleted ones are added again, copies lose their claim to a grade.
Points, cell types and grade ids come from the source notebook, never from the submission.
"""

from __future__ import annotations

import copy

import nbformat
from nbformat import NotebookNode

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError

MAX_CELLS = 500
DELETED = "# This cell was deleted."
STUB = "YOUR CODE HERE"


def read(data: bytes, name: str) -> NotebookNode:
    """Read a notebook of the current format.

    Raises:
        StudentError: it is no JSON, no notebook, or one of another format.
    """
    try:
        notebook = nbformat.reads(data.decode("utf-8"), as_version=4)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat passes on whatever a malformed structure makes it trip over
        reason = str(error).strip().splitlines()[0][:200] if str(error).strip() else type(error).__name__
        sentence = (
            f"{name} cannot be read as a notebook ({reason}): open it in JupyterLab, save it and hand it in again."
        )
        raise StudentError(Diagnosis(Kind.UNREADABLE, sentence)) from None
    if len(notebook.cells) > MAX_CELLS:
        raise StudentError(Diagnosis(Kind.UNREADABLE, f"{name} has {len(notebook.cells)} cells, {MAX_CELLS} at most."))
    return notebook


def restore(submitted: NotebookNode, source: NotebookNode) -> NotebookNode:
    """Return the submitted notebook with every cell that nbgrader marks as the source notebook has it.

    Cells that the student may edit keep the student's text, and are empty where the student deleted them. Outputs are
    dropped.
    """
    originals = {grade_id(cell): cell for cell in source.cells if grade_id(cell)}
    notebook = copy.deepcopy(submitted)
    seen: set[str] = set()
    for cell in notebook.cells:
        name = grade_id(cell)
        cell.metadata.pop("nbgrader", None)
        if name in originals and name not in seen:
            seen.add(name)
            _mend(cell, originals[name])
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    notebook.cells += [_put_back(cell) for name, cell in originals.items() if name not in seen]
    notebook.metadata = copy.deepcopy(source.metadata)
    return notebook


def _put_back(original: NotebookNode) -> NotebookNode:
    """Return a cell that the student deleted; an exercise comes back empty: the source notebook holds its answer."""
    cell = copy.deepcopy(original)
    if cell.metadata.nbgrader.get("solution"):
        cell.source = DELETED
    return cell


def grade_id(cell: NotebookNode) -> str:
    """Return the name by which nbgrader knows a cell, or an empty string."""
    marks = cell.metadata.get("nbgrader")
    name = marks.get("grade_id") if isinstance(marks, dict) else None
    return name if isinstance(name, str) else ""


def _mend(cell: NotebookNode, original: NotebookNode) -> None:
    marks = original.metadata.nbgrader
    if marks.get("locked") or not marks.get("solution") or cell.cell_type != original.cell_type:
        text = cell.source if marks.get("solution") and not marks.get("locked") else original.source
        cell.clear()
        cell.update(copy.deepcopy(original))
        cell.source = text
    else:
        cell.metadata = copy.deepcopy(original.metadata)
