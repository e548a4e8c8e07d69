"""Keeps the notebooks and the reference solutions equal, checks the notebooks and executes them.

`solutions/` is the single source. The metadata of a cell or a notebook names the files that it copies. `sync_chapter`
writes the copies, and `find_outdated` compares them. `run_notebook` executes one form of a notebook: the source, the
solved or the released one. `run_notebooks` executes several at once.
"""

from autograder.course.cells import is_solution, origin
from autograder.course.exceptions import CourseError
from autograder.course.execute import Execution, run_notebook, run_notebooks
from autograder.course.findings import Finding
from autograder.course.forms import CODE_STUB, Form, in_form
from autograder.course.notebook_rules import broken_rules
from autograder.course.points import set_points, wrong_points
from autograder.course.solution_markers import mark_functions, strip_licence
from autograder.course.sync import Chapter, chapters, find_outdated, sync_chapter

__all__ = [
    "CODE_STUB",
    "Chapter",
    "CourseError",
    "Execution",
    "Finding",
    "Form",
    "broken_rules",
    "chapters",
    "find_outdated",
    "in_form",
    "is_solution",
    "mark_functions",
    "origin",
    "run_notebook",
    "run_notebooks",
    "set_points",
    "strip_licence",
    "sync_chapter",
    "wrong_points",
]
