"""Grading in the place where nbgrader would execute a notebook.

The submitted folder is graded in a sandbox, and the scores are written into the locked grade cells, for nbgrader's own
code to book.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import nbformat
from nbformat import NotebookNode
from nbformat.v4 import new_notebook
from nbgrader.api import Gradebook
from nbgrader.preprocessors import NbGraderPreprocessor
from nbgrader.utils import is_grade, is_solution
from traitlets import Bool, Integer, Unicode

from autograder import feedback
from autograder.exceptions import GraderError
from autograder.feedback.model import view
from autograder.feedback.pictures import from_folder
from autograder.feedback.text import clean
from autograder.grading import DEFAULT_SEED
from autograder.grading.batch import Entry, grade_all
from autograder.grading.pipeline import NOTEBOOK
from autograder.grading.submitted_notebook import grade_id
from autograder.nbgrader.outputs import harmless, verdict
from autograder.result import Result, Status
from autograder.sandbox import Tier


class SandboxedGrade(NbGraderPreprocessor):
    """Grades a submission and fills the notebook's outputs. No code of a student's runs in this process."""

    seed = Integer(DEFAULT_SEED, help="Every hidden input is drawn from this seed.").tag(config=True)
    isolation = Unicode(Tier.BUBBLEWRAP.value, help="How submissions are isolated: a tier's name.").tag(config=True)
    resume = Bool(
        False,
        help="Book a result stored below `results` if its submission, suite and seed are the same, instead of grading "
        "again: `autograder grade submitted --assignment ID --out .build/nbgrader/ID -j N` grades a class in parallel.",
    ).tag(config=True)
    after_due = Bool(False, help="Also show the checks that stay closed until the due date.").tag(config=True)
    results = Unicode(
        ".build/nbgrader", help="Where results go: <results>/<assignment>/<student>/, from the course directory."
    ).tag(config=True)

    def preprocess(self, nb: NotebookNode, resources: dict[str, Any]) -> tuple[NotebookNode, dict[str, Any]]:
        """Grade the submitted folder that this notebook came from.

        Raises:
            GraderError: it could not be graded, or the notebook's grade cells do not fit the suite. Nothing is booked.
        """
        coursedir = self.parent.parent.coursedir
        marks = resources["nbgrader"]
        assignment, student = marks["assignment"], marks["student"]
        submitted = Path(coursedir.format_path(coursedir.submitted_directory, student, assignment))
        results = Path(coursedir.root) / self.results / assignment
        try:
            (result,) = grade_all(
                (Entry(student, submitted),),
                assignment,
                seed=self.seed,
                out=results,
                jobs=1,
                isolation=Tier(self.isolation),
                resume=self.resume,
            )
            if result.status is Status.NOT_GRADED:
                raise GraderError(f"{student}: not graded, nothing is booked. {result.diagnosis.sentence}")
            if result.isolation != self.isolation:
                raise GraderError(
                    f"{student}: the stored result was graded with the isolation {result.isolation!r}, not "
                    f"{self.isolation!r}: grade it again, without SandboxedGrade.resume"
                )
            self._fill(nb, results / student / NOTEBOOK)
            self._judge(nb, result, results / student)
            feedback.write(result, results / student, after_due=self.after_due)
        except Exception:
            self._flag(marks)
            raise
        return nb, resources

    def _fill(self, nb: NotebookNode, executed: Path) -> None:
        """Take over the outputs of the sandboxed run, cell by cell where the source is the same."""
        notebook = nbformat.read(executed, as_version=4) if executed.is_file() else new_notebook()
        cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
        count = Counter(_name(cell) for cell in cells)
        ran = {_name(cell): cell for cell in cells if count[_name(cell)] == 1}
        for cell in nb.cells:
            if cell.cell_type == "code":
                same = ran.get(_name(cell))
                outputs = [] if same is None or clean(same.source) != cell.source else same.outputs
                cell.outputs = harmless(outputs)
                cell.execution_count = None

    def _judge(self, nb: NotebookNode, result: Result, out: Path) -> None:
        """Put the score of each group, and what explains it, below the locked grade cell that stands for it."""
        page = view(result, from_folder(out), after_due=self.after_due)
        groups = {group.name: group for group in page.groups}
        graded = [cell for cell in nb.cells if is_grade(cell) and not is_solution(cell)]
        named = [_group(cell) for cell in graded]
        if sorted(named) != sorted(groups):
            raise GraderError(
                f"{result.assignment}: its grade cells stand for the groups {sorted(named)}, but its suite has "
                f"{sorted(groups)}: mend the source notebook and run `nbgrader generate_assignment` again"
            )
        for cell, name in zip(graded, named, strict=True):
            group, worth = groups[name], float(cell.metadata.nbgrader["points"])
            if abs(group.max_points - worth) > 1e-6:
                raise GraderError(
                    f"{result.assignment}: the cell of group {name!r} is worth {worth:g} points, its checks "
                    f"{group.max_points:g}: run `nbgrader generate_assignment` again"
                )
            points = min(max(round(group.points, 4), 0.0), worth)
            cell.outputs = verdict(points, page, group, first=cell is graded[0])

    def _flag(self, marks: dict[str, str]) -> None:
        """Mark the submission for the instructor's eye. A score booked earlier stays as it is; no new one is made."""
        with Gradebook(marks["db_url"]) as gradebook:
            submission = gradebook.find_submission_notebook(marks["notebook"], marks["assignment"], marks["student"])
            for grade in submission.grades:
                grade.needs_manual_grade = True
            gradebook.db.commit()


def _name(cell: NotebookNode) -> str:
    """Return what a cell is matched by: its grade id, or else its own id."""
    return f"grade {grade_id(cell)}" if grade_id(cell) else f"cell {cell.get('id')}"


def _group(cell: NotebookNode) -> str:
    course = cell.metadata.get("course")
    group = course.get("group") if isinstance(course, dict) else None
    return group if isinstance(group, str) else f"(none, cell {cell.metadata.nbgrader['grade_id']})"
