"""A tiny course in a separate folder, processed with nbgrader's API and this repository's configuration."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook
from nbgrader.api import Gradebook
from nbgrader.apps import NbGraderAPI
from nbgrader.coursedir import CourseDirectory
from traitlets.config.loader import PyFileConfigLoader

import autograder.grade.batch
from autograder.grade.job import Job
from autograder.grade.store import NOTEBOOK
from autograder.result.model import CheckResult, Result
from autograder.suite import Check, Outcome

ROOT = Path(__file__).resolve().parents[3]
ASSIGNMENT = "tiny"


def marked(cell: NotebookNode, grade_id: str, **marks: Any) -> NotebookNode:
    """Give a cell nbgrader's marks."""
    base = {"grade": False, "solution": False, "locked": False, "task": False, "schema_version": 3}
    cell.metadata.nbgrader = {**base, "grade_id": grade_id, **marks}
    return cell


def source_notebook() -> NotebookNode:
    def grade(group: str, points: float) -> NotebookNode:
        cell = marked(new_code_cell("pass", id=f"g-{group}"), f"grade-{group}", grade=True, locked=True, points=points)
        cell.metadata.course = {"group": group}
        return cell

    solution = "%%writefile x.py\ndef answer():\n    # BEGIN SOLUTION\n    return 'SECRET'\n    # END SOLUTION"
    return new_notebook(
        metadata={"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}},
        cells=[
            new_markdown_cell("# Tiny", id="title"),
            marked(new_code_cell(solution, id="solve"), "solve", solution=True),
            new_code_cell("print('free')", id="free"),
            grade("graph", 3.0),
            grade("reaction", 4.0),
        ],
    )


@dataclass
class Graded:
    """A result of the grader, and the notebook that it writes beside the result."""

    result: Result
    notebook: NotebookNode | None


@dataclass
class Course:
    """A course directory and nbgrader on it."""

    root: Path
    api: Any
    grade: Callable[[Job], Graded] = field(default=lambda _: pytest.fail("nothing was to be graded"))

    @property
    def released(self) -> NotebookNode:
        return nbformat.read(self.root / "release" / "." / ASSIGNMENT / f"{ASSIGNMENT}.ipynb", as_version=4)

    def submit(self, student: str, notebook: NotebookNode | bytes) -> Path:
        """Put a notebook where `nbgrader collect` would."""
        folder = self.root / "submitted" / student / ASSIGNMENT
        folder.mkdir(parents=True)
        file = folder / f"{ASSIGNMENT}.ipynb"
        file.write_bytes(notebook if isinstance(notebook, bytes) else json.dumps(notebook).encode())
        return folder

    def autograde(self, student: str, **options: Any) -> dict[str, Any]:
        response: dict[str, Any] = self.api.autograde(ASSIGNMENT, student, **options)
        return response

    def feedback(self, student: str) -> str:
        response = self.api.generate_feedback(ASSIGNMENT, student)
        assert response["success"], response
        return (self.root / "feedback" / student / ASSIGNMENT / f"{ASSIGNMENT}.html").read_text(encoding="utf-8")

    def autograded(self, student: str) -> NotebookNode:
        return nbformat.read(self.root / "autograded" / student / ASSIGNMENT / f"{ASSIGNMENT}.ipynb", as_version=4)

    def grades(self, student: str) -> dict[str, tuple[float | None, float, bool]]:
        """Return (recorded points, maximum, whether a person has to grade it) by grade cell."""
        with Gradebook(f"sqlite:///{self.root}/gradebook.db") as gradebook:
            submission = gradebook.find_submission_notebook(ASSIGNMENT, ASSIGNMENT, student)
            return {g.name: (g.auto_score, g.max_score, g.needs_manual_grade) for g in submission.grades}


def course_in(root: Path) -> Course:
    """Open the course directory `root` with its configuration file."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PATH", os.environ["PATH"])  # the configuration changes it; this brings it back
        config = PyFileConfigLoader("nbgrader_config.py", path=str(root)).load_config()
    return Course(root, NbGraderAPI(CourseDirectory(config=config), config=config))


@pytest.fixture(scope="session")
def generated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A course directory after `nbgrader generate_assignment`."""
    root = tmp_path_factory.mktemp("course")
    source = root / "chapters" / ASSIGNMENT
    source.mkdir(parents=True)
    nbformat.write(source_notebook(), source / f"{ASSIGNMENT}.ipynb")
    shutil.copy(ROOT / "nbgrader_config.py", root)
    with pytest.MonkeyPatch.context() as patch:
        # nbgrader starts `alembic` by name to make its database.
        patch.setenv("PATH", os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]))
        response = course_in(root).api.generate_assignment(ASSIGNMENT)
    assert response["success"], response
    return root


@pytest.fixture
def course(generated: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Course:
    """A copy of the generated course, with the grader replaced by the function that the test sets as `grade`."""
    created = course_in(Path(shutil.copytree(generated, tmp_path / "course")))

    def grade(job: Job) -> Result:
        graded = created.grade(job)
        job.out.mkdir(parents=True, exist_ok=True)
        if graded.notebook is not None:
            nbformat.write(graded.notebook, job.out / NOTEBOOK)
        return replace(graded.result, student=job.student)

    monkeypatch.setattr(autograder.grade.batch, "grade_submission", grade)
    return created


@pytest.fixture
def verdict(make_check: Callable[..., Check], make_result: Callable[..., Result]) -> Callable[..., Graded]:
    """Make a result of the grader: 3 of 3 points in `graph`, 1 of 4 in `reaction`."""

    def make(notebook: NotebookNode | None = None, **fields: Any) -> Graded:
        checks = (
            CheckResult.of(make_check("starts", "The node starts.", 3, "graph"), Outcome.PASSED),
            CheckResult.of(
                make_check("turns", "The robot turns.", 4, "reaction", hints=("Where is 0 rad?",)),
                Outcome.FAILED,
                "it drove on <b>and on</b>",
                fraction=0.25,
            ),
        )
        base = {"assignment": ASSIGNMENT, "checks": checks, "max_score": 7.0}
        return Graded(make_result(**(base | fields)), notebook)

    return make
