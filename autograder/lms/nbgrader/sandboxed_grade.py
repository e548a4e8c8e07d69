"""Grades the submitted folder, instead of letting nbgrader execute the notebook.

The folder is graded in a sandbox. The scores are written into the locked grade cells, where nbgrader reads them.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

from nbformat import NotebookNode
from nbgrader.api import Gradebook
from nbgrader.preprocessors import NbGraderPreprocessor
from nbgrader.utils import is_grade, is_solution
from traitlets import Integer, Unicode

from autograder.author.course.cells import group
from autograder.exceptions import GraderError
from autograder.grade import DEFAULT_SEED
from autograder.grade.batch import grade_all
from autograder.grade.executed_notebook import decode
from autograder.grade.store import LOG, NOTEBOOK
from autograder.grade.submitted_notebook import grade_id
from autograder.lms.nbgrader.outputs import grade_outputs, sanitized_outputs
from autograder.plain_text import clean
from autograder.report import feedback
from autograder.report.feedback.model import page_view
from autograder.result.model import Result, Status
from autograder.run.sandbox import Isolation


class SandboxedGrade(NbGraderPreprocessor):
    """Grades a submission and writes the notebook's outputs. This process runs no student code."""

    seed = Integer(DEFAULT_SEED, help="The seed of every hidden input.").tag(config=True)
    isolation = Unicode(Isolation.BUBBLEWRAP.value, help="The isolation level: bubblewrap or process.").tag(config=True)
    results = Unicode(
        ".build/nbgrader",
        help="The folder of results, relative to the course directory: ASSIGNMENT/STUDENT/result.json. A stored "
        "result is recorded without grading again if submission, suite, seed and isolation level are unchanged.",
    ).tag(config=True)

    def preprocess(self, nb: NotebookNode, resources: dict[str, Any]) -> tuple[NotebookNode, dict[str, Any]]:
        """Grade the submitted folder of this notebook, and write its outputs.

        Args:
            nb: the submitted notebook, after sanitizing.
            resources: nbgrader's resources; `resources["nbgrader"]` names the assignment, the student and the
                database.

        Raises:
            GraderError: the submission could not be graded, or the grade cells do not match the suite. In that case
                nothing is recorded.
        """
        coursedir = self.parent.parent.coursedir
        nbgrader_resources = resources["nbgrader"]
        assignment, student = nbgrader_resources["assignment"], nbgrader_resources["student"]
        submitted_folder = Path(coursedir.format_path(coursedir.submitted_directory, student, assignment))
        results = Path(coursedir.root) / self.results / assignment
        try:
            (result,) = grade_all(
                {student: submitted_folder},
                assignment,
                seed=self.seed,
                out=results,
                jobs=1,
                isolation=Isolation(self.isolation),
                resume=True,
            )
            if result.status is not Status.GRADED:
                raise GraderError(f"{student}: not graded, no score was recorded. {result.diagnosis.sentence}")
            if result.unjudged:
                checks, log = ", ".join(result.unjudged), results / student / LOG
                self.log.warning("%s: %s failed because the check raised an error: see %s", student, checks, log)
            self._copy_outputs(nb, results / student / NOTEBOOK)
            self._write_scores(nb, result, results / student)
            feedback.write(result, results / student)
        except Exception:
            self._request_manual_grading(nbgrader_resources)
            raise
        return nb, resources

    def _copy_outputs(self, nb: NotebookNode, executed_path: Path) -> None:
        """Copy the outputs of the sandboxed run into the cells whose source is unchanged."""
        try:
            cells = decode(executed_path.read_bytes()) if executed_path.is_file() else []
        except (ValueError, RecursionError) as error:
            raise GraderError(f"{executed_path} cannot be read: {error}. Delete its folder, and grade again") from None
        count = Counter(_key(cell) for cell in cells)
        executed_cells = {_key(cell): cell for cell in cells if count[_key(cell)] == 1}
        for cell in nb.cells:
            if cell.cell_type == "code":
                match = executed_cells.get(_key(cell))
                outputs = [] if match is None or clean(match.source) != cell.source else match.outputs
                cell.outputs = sanitized_outputs(outputs)
                cell.execution_count = None

    def _write_scores(self, nb: NotebookNode, result: Result, out: Path) -> None:
        """Write each group's score and feedback to the outputs of its locked grade cell."""
        page = page_view(result, out)
        groups = {view.name: view for view in page.groups}
        grade_cells = [cell for cell in nb.cells if is_grade(cell) and not is_solution(cell)]
        names = [group(cell) or f"(none, cell {grade_id(cell)})" for cell in grade_cells]
        if sorted(names) != sorted(groups):
            raise GraderError(
                f"{result.assignment}: its grade cells have the groups {sorted(names)}, but its suite has "
                f"{sorted(groups)}: correct the source notebook and run `nbgrader generate_assignment` again"
            )
        for cell, name in zip(grade_cells, names, strict=True):
            view, max_points = groups[name], float(cell.metadata.nbgrader["points"])
            if abs(view.max_points - max_points) > 1e-6:
                raise GraderError(
                    f"{result.assignment}: the cell of group {name!r} is worth {max_points:g} points, but its checks "
                    f"are worth {view.max_points:g}: run `nbgrader generate_assignment` again"
                )
            points = min(max(round(view.points, 4), 0.0), max_points)
            cell.outputs = grade_outputs(points, page, view, first=cell is grade_cells[0])

    def _request_manual_grading(self, names: dict[str, str]) -> None:
        """Mark the submission for manual grading. A previously recorded score is kept."""
        with Gradebook(names["db_url"]) as gradebook:
            submission = gradebook.find_submission_notebook(names["notebook"], names["assignment"], names["student"])
            for grade in submission.grades:
                grade.needs_manual_grade = True
            gradebook.db.commit()


def _key(cell: NotebookNode) -> str:
    """Return the key for matching cells: the grade id, or the cell id if there is none."""
    return f"grade {grade_id(cell)}" if grade_id(cell) else f"cell {cell.get('id')}"
