"""The three forms of a notebook: source, solved and released."""

from __future__ import annotations

import copy
from enum import Enum

import nbformat
from nbformat import NotebookNode

from autograder.author.course.solution_markers import strip_markers
from autograder.submission.exercise_stubs import CODE_STUB

# The settings of nbgrader's preprocessors.
SETTINGS = {
    "ClearSolutions": {"code_stub": {"python": CODE_STUB}},
    # A mark scheme is in the locked cell of its question, where autograding restores it.
    "ClearMarkScheme": {"enforce_metadata": False},
}


class Form(str, Enum):
    """The forms of a notebook: as written by its author, as solved by a student, and as released to students."""

    SOURCE = "source"
    SOLVED = "solved"
    RELEASED = "released"


def in_form(notebook: NotebookNode, form: Form) -> NotebookNode:
    """Return a copy of a source notebook in the given form, without outputs.

    nbgrader's own preprocessors create the released form, so it is exactly what students get.
    """
    result: NotebookNode = copy.deepcopy(notebook)
    if form is Form.SOLVED:
        for cell in result.cells:
            cell.source = strip_markers(cell.source)
        result = _preprocess(result, "ClearMarkScheme")
    elif form is Form.RELEASED:
        result = _preprocess(
            result,
            "LockCells",
            "ClearSolutions",
            "ClearOutput",
            "CheckCellMetadata",
            "ClearHiddenTests",
            "ClearMarkScheme",
        )
    nbformat.validate(result)
    return result


def _preprocess(notebook: NotebookNode, *steps: str) -> NotebookNode:
    # Imported here because nbgrader takes a second to import, and the source form does not need it.
    from nbgrader import preprocessors
    from traitlets.config import Config

    for step in steps:
        notebook, _ = getattr(preprocessors, step)(config=Config(SETTINGS)).preprocess(notebook, {})
    return notebook
