"""An answer that a person reads: autograding leaves its grade open, and brings the mark scheme to formgrader."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_markdown_cell
from nbgrader.api import Gradebook

from .conftest import ASSIGNMENT, ROOT, course_in, marked, source_notebook

# nbgrader's own use of SQLAlchemy.
pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]

QUESTION = "## Explain\n\nWhy?\n\n### BEGIN MARK SCHEME\nOne point for BECAUSE.\n### END MARK SCHEME"
ANSWER = "# BEGIN SOLUTION\nFor a SECRET reason.\n# END SOLUTION"
TRUSTED = {"grade-graph": (3.0, 3.0, False), "grade-reaction": (1.0, 4.0, False)}


@pytest.fixture(scope="module")
def generated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A course directory, after `nbgrader generate_assignment`, with a question that a person marks."""
    root = tmp_path_factory.mktemp("manual")
    source = root / "chapters" / ASSIGNMENT
    source.mkdir(parents=True)
    notebook = source_notebook()
    notebook.cells += [
        marked(new_markdown_cell(QUESTION, id="question"), "question", locked=True),
        marked(new_markdown_cell(ANSWER, id="explain"), "explain", grade=True, solution=True, points=2.0),
    ]
    nbformat.write(notebook, source / f"{ASSIGNMENT}.ipynb")
    shutil.copy(ROOT / "nbgrader_config.py", root)
    response = course_in(root).api.generate_assignment(ASSIGNMENT)
    assert response["success"], response
    return root


def cell(notebook: NotebookNode, id: str) -> NotebookNode:
    return next(cell for cell in notebook.cells if cell.id == id)


def answered(course: Any, text: str) -> NotebookNode:
    notebook: NotebookNode = course.released
    cell(notebook, "explain").source = text
    return notebook


def test_the_release_contains_neither_the_mark_scheme_nor_the_model_answer(course: Any) -> None:
    text = "\n".join(cell.source for cell in course.released.cells)
    assert "Why?" in text
    assert not [word for word in ("BECAUSE", "MARK SCHEME", "SECRET") if word in text]


def test_autograding_leaves_the_grade_of_an_answer_open(course: Any, verdict: Callable[..., Any]) -> None:
    course.grade = lambda job: verdict()
    course.submit("alice", answered(course, "Because it is so."))
    assert course.autograde("alice")["success"]
    assert course.grades("alice") == {**TRUSTED, "explain": (None, 2.0, True)}


def test_an_unwritten_answer_has_no_points_and_needs_no_manual_grading(
    course: Any, verdict: Callable[..., Any]
) -> None:
    course.grade = lambda job: verdict()
    course.submit("bob", course.released)
    assert course.autograde("bob")["success"]
    assert course.grades("bob") == {**TRUSTED, "explain": (0.0, 2.0, False)}


@pytest.mark.promise("which shows the mark scheme above each answer")
def test_formgrader_shows_the_answer_below_the_mark_scheme(course: Any, verdict: Callable[..., Any]) -> None:
    course.grade = lambda job: verdict()
    course.submit("alice", answered(course, "Because it is so."))
    assert course.autograde("alice")["success"]
    assert "One point for BECAUSE." in cell(course.autograded("alice"), "question").source
    assert cell(course.autograded("alice"), "explain").source == "Because it is so."


def test_points_of_a_person_are_added_and_kept_at_the_next_autograding(
    course: Any, verdict: Callable[..., Any]
) -> None:
    course.grade = lambda job: verdict()
    course.submit("alice", answered(course, "Because it is so."))
    assert course.autograde("alice")["success"]
    with Gradebook(f"sqlite:///{course.root}/gradebook.db") as gradebook:
        grade = gradebook.find_grade("explain", ASSIGNMENT, ASSIGNMENT, "alice")
        grade.manual_score, grade.needs_manual_grade = 1.5, False
        gradebook.db.commit()
    assert "(Score: 5.5 / 9.0)" in course.feedback("alice")
    assert course.autograde("alice", force=True)["success"]
    with Gradebook(f"sqlite:///{course.root}/gradebook.db") as gradebook:
        assert gradebook.find_grade("explain", ASSIGNMENT, ASSIGNMENT, "alice").manual_score == 1.5


def test_an_answer_cell_with_forged_marks_still_needs_manual_grading(course: Any, verdict: Callable[..., Any]) -> None:
    notebook = answered(course, "### BEGIN MARK SCHEME\nAll points.\n### END MARK SCHEME")
    cell(notebook, "explain").metadata.nbgrader.update(points=100, solution=False, locked=True)
    cell(notebook, "question").source = "No marks are taken off."
    course.grade = lambda job: verdict()
    course.submit("mallory", notebook)
    assert course.autograde("mallory")["success"]
    assert course.grades("mallory") == {**TRUSTED, "explain": (None, 2.0, True)}
    assert "BECAUSE" in cell(course.autograded("mallory"), "question").source
