"""Restores the cells of a submitted notebook that students may not change.

Locked cells get the text of the source notebook. Deleted cells are restored. Copies of graded cells lose their grade
id. Points, cell types and grade ids are taken from the source notebook, never from the submission.
"""

from __future__ import annotations

import copy
from itertools import pairwise

import nbformat
from nbformat import NotebookNode

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.intake.notebooks import Cell, read_cells

MAX_CELLS = 500
DELETED = "# This cell was deleted."
STUB = "YOUR CODE HERE"


def read(data: bytes, name: str) -> NotebookNode:
    """Read a submitted notebook, without its outputs; `name` is the file's name in the error.

    Raises:
        StudentError: the file is not JSON, not a notebook or a notebook of another format, or it has too many cells.
    """
    try:
        notebook = _notebook(read_cells(data))
    except ValueError as error:
        sentence = (
            f"{name} cannot be read as a notebook ({str(error)[:200]}): open it in JupyterLab, save it and hand it in "
            "again."
        )
        raise StudentError(Diagnosis(Kind.UNREADABLE, sentence)) from None
    if len(notebook.cells) > MAX_CELLS:
        sentence = f"{name} has {len(notebook.cells)} cells: at most {MAX_CELLS} are allowed."
        raise StudentError(Diagnosis(Kind.UNREADABLE, sentence))
    return notebook


def _notebook(cells: list[Cell]) -> NotebookNode:
    """Return a notebook of format 4.5 with these cells."""
    no_outputs: dict[str, object] = {"outputs": [], "execution_count": None}
    nodes = [{**cell, **(no_outputs if cell["cell_type"] == "code" else {})} for cell in cells]
    notebook: NotebookNode = nbformat.from_dict({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": nodes})
    return notebook


def restore(submitted: NotebookNode, source: NotebookNode) -> NotebookNode:
    """Return a copy of the submitted notebook with the source notebook's nbgrader cells, and without outputs.

    Cells that students may edit keep the student's text. If the student deleted such a cell, it is restored with a
    comment that reports this. Cells that the student added lose their metadata, which is never read and may be large.
    """
    originals = {grade_id(cell): cell for cell in source.cells if grade_id(cell)}
    ids = _grade_ids(submitted.cells, source.cells)
    cells = [NotebookNode({**cell, "metadata": NotebookNode()}) for cell in submitted.cells]
    notebook = copy.deepcopy(NotebookNode({**submitted, "cells": cells}))
    restored: set[str] = set()
    for cell, name in zip(notebook.cells, ids, strict=True):
        if name in originals and name not in restored:
            restored.add(name)
            _restore_cell(cell, originals[name])
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    notebook.cells += [_deleted_cell(cell) for name, cell in originals.items() if name not in restored]
    notebook.metadata = copy.deepcopy(source.metadata)
    return notebook


def _grade_ids(cells: list[NotebookNode], source: list[NotebookNode]) -> list[str]:
    """Return the grade ids of submitted cells, including cells whose metadata a tool has dropped.

    Such a cell is recognised by its cell id. An answer is also recognised by the first line of the question above it.
    """
    names = [grade_id(cell) for cell in cells]
    ids = {cell.get("id"): grade_id(cell) for cell in source}
    by_question = {
        (_first_line(above), cell.cell_type): grade_id(cell)
        for above, cell in pairwise(source)
        if cell.metadata.get("nbgrader", {}).get("solution")
    }
    preceding = [None, *cells[:-1]] if cells else []
    for index, (above, cell) in enumerate(zip(preceding, cells, strict=True)):
        if not names[index] and (name := ids.get(cell.get("id"), "")) not in names:
            names[index] = name
        if not names[index] and above is not None and "nbgrader" not in cell.metadata:
            name = by_question.get((_first_line(above), cell.cell_type), "")
            names[index] = name if name not in names else ""
    return names


def _first_line(cell: NotebookNode) -> str:
    return str(cell.source).strip().partition("\n")[0].strip()


def _deleted_cell(original: NotebookNode) -> NotebookNode:
    """Return a new copy of a deleted cell. If it is an exercise, the copy omits the answer in the source notebook."""
    cell = copy.deepcopy(original)
    if cell.metadata.nbgrader.get("solution"):
        cell.source = DELETED
    return cell


def grade_id(cell: NotebookNode) -> str:
    """Return the grade id of a cell, or an empty string."""
    nbgrader = cell.metadata.get("nbgrader")
    name = nbgrader.get("grade_id") if isinstance(nbgrader, dict) else None
    return name if isinstance(name, str) else ""


def _restore_cell(cell: NotebookNode, original: NotebookNode) -> None:
    nbgrader = original.metadata.nbgrader
    if nbgrader.get("locked") or not nbgrader.get("solution") or cell.cell_type != original.cell_type:
        text = cell.source if nbgrader.get("solution") and not nbgrader.get("locked") else original.source
        cell.clear()
        cell.update(copy.deepcopy(original))
        cell.source = text
    else:
        cell.metadata = copy.deepcopy(original.metadata)
