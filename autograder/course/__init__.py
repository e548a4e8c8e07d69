"""The course's own tool: it brings the reference solutions into the notebooks, and looks after the notebooks.

`solutions/` is the single source. A notebook's cell or file that comes from it says so in its metadata; `sync` writes
it, `check` finds what has gone stale, `run_notebook` executes a notebook as the author, the grader or a student
has it, `run_notebooks` several at once.
"""

from autograder.course.cells import is_solution, origin
from autograder.course.exceptions import CourseError
from autograder.course.execute import Execution, run_notebook, run_notebooks
from autograder.course.findings import Finding
from autograder.course.forms import CODE_STUB, Form, in_form
from autograder.course.notebook_rules import broken_rules
from autograder.course.points import set_points, wrong_points
from autograder.course.solution_markers import with_holes, without_licence
from autograder.course.sync import Chapter, chapters, stale, sync

__all__ = [
    "CODE_STUB",
    "Chapter",
    "CourseError",
    "Execution",
    "Finding",
    "Form",
    "broken_rules",
    "chapters",
    "in_form",
    "is_solution",
    "origin",
    "run_notebook",
    "run_notebooks",
    "set_points",
    "stale",
    "sync",
    "with_holes",
    "without_licence",
    "wrong_points",
]
