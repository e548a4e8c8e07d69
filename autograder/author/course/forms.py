"""The three forms of a notebook: as its author has it, as a student who solved it has it, and as it is released."""

from __future__ import annotations

import copy
from enum import Enum

import nbformat
from nbformat import NotebookNode

from autograder.author.course.solution_markers import strip_markers
from autograder.submission.exercise_stubs import CODE_STUB

# The settings of nbgrader for each form that it makes.
SETTINGS = {
    "ClearSolutions": {"code_stub": {"python": CODE_STUB}},
    # A mark scheme stands in the locked cell of its question, where autograding brings it back.
    "ClearMarkScheme": {"enforce_metadata": False},
}


class Form(str, Enum):
    """The forms of a notebook: as its author wrote it, solved, or as students get it."""

    SOURCE = "source"
    SOLVED = "solved"
    RELEASED = "released"


def in_form(notebook: NotebookNode, form: Form) -> NotebookNode:
    """Return a copy of a source notebook in the given form, without outputs.

    nbgrader's own preprocessors make the released form, so it is the text that students get.
    """
    made: NotebookNode = copy.deepcopy(notebook)
    if form is Form.SOLVED:
        for cell in made.cells:
            cell.source = strip_markers(cell.source)
        made = _preprocessed(made, "ClearMarkScheme")
    elif form is Form.RELEASED:
        made = _preprocessed(
            made,
            "LockCells",
            "ClearSolutions",
            "ClearOutput",
            "CheckCellMetadata",
            "ClearHiddenTests",
            "ClearMarkScheme",
        )
    nbformat.validate(made)
    return made


def _preprocessed(notebook: NotebookNode, *steps: str) -> NotebookNode:
    # Here because nbgrader takes a second to import, and the source form does not need it.
    from nbgrader import preprocessors
    from traitlets.config import Config

    for step in steps:
        notebook, _ = getattr(preprocessors, step)(config=Config(SETTINGS)).preprocess(notebook, {})
    return notebook
