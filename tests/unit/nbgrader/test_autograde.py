"""Autograding through nbgrader: the recorded scores, the feedback, and notebooks that try to change them."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_output

from autograder.exceptions import IsolationError
from autograder.grade import DEFAULT_SEED
from autograder.grade.job import Job
from autograder.result.model import Artifact, CheckResult, Status
from autograder.suite import Check, Outcome

# nbgrader's own use of SQLAlchemy.
pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]

RECORDED = {"grade-graph": (3.0, 3.0, False), "grade-reaction": (1.0, 4.0, False)}


def cell(notebook: NotebookNode, id: str) -> NotebookNode:
    return next(cell for cell in notebook.cells if cell.id == id)


def test_the_release_contains_the_stub_and_not_the_solution(course: Any) -> None:
    solve = cell(course.released, "solve")
    assert "SECRET" not in solve.source
    assert solve.source.startswith(
        "%%writefile x.py\ndef answer():\n    # YOUR CODE HERE\n    raise NotImplementedError("
    )


def test_the_score_of_each_group_is_recorded(course: Any, verdict: Callable[..., Any]) -> None:
    jobs: list[Job] = []

    def grade(job: Job) -> Any:
        jobs.append(job)
        return verdict()

    course.grade = grade
    folder = course.submit("alice", course.released)
    assert course.autograde("alice")["success"]
    assert course.grades("alice") == RECORDED
    out = course.root / ".build" / "nbgrader" / "tiny" / "alice"
    assert jobs == [Job(folder, "tiny", "alice", DEFAULT_SEED, out)]
    assert (out / "feedback.html").is_file()


def test_the_submitted_notebook_is_not_executed(course: Any, verdict: Callable[..., Any], tmp_path: Path) -> None:
    marker = tmp_path / "executed"
    notebook = course.released
    cell(notebook, "free").source = f"open({str(marker)!r}, 'w')"
    course.grade = lambda job: verdict()
    course.submit("alice", notebook)
    assert course.autograde("alice")["success"]
    assert not marker.exists()
    assert cell(course.autograded("alice"), "free").outputs == []


def test_outputs_of_the_sandboxed_run_are_shown_where_the_source_is_the_same(
    course: Any, verdict: Callable[..., Any]
) -> None:
    notebook = course.released
    executed = copy.deepcopy(notebook)
    cell(executed, "free").outputs = [new_output("stream", text="free\n")]
    cell(executed, "solve").source += "\n# other"
    cell(executed, "solve").outputs = [new_output("stream", text="from another source")]
    course.grade = lambda job: verdict(executed)
    course.submit("alice", notebook)
    assert course.autograde("alice")["success"]
    assert [output.text for output in cell(course.autograded("alice"), "free").outputs] == ["free\n"]
    assert cell(course.autograded("alice"), "solve").outputs == []


def test_feedback_explains_each_group_and_shows_the_track(
    course: Any, verdict: Callable[..., Any], track: Callable[..., Artifact]
) -> None:
    course.grade = lambda job: verdict(artifacts=(track(job.out, check="turns"),))
    course.submit("alice", course.released)
    assert course.autograde("alice")["success"]
    html = course.feedback("alice")
    for words in ("(Score: 4.0 / 7.0)", "The robot turns.", "it drove on &lt;b&gt;and on&lt;/b&gt;", "Where is 0 rad?"):
        assert words in html
    assert 'alt="The robot\'s track: it touches the north wall at t = 12.4 s."' in html
    assert html.count("data:image/png;base64,") == 1


def test_forged_outputs_and_metadata_earn_no_points(course: Any, verdict: Callable[..., Any]) -> None:
    notebook = course.released
    forged = cell(notebook, "g-reaction")
    forged.outputs = [new_output("execute_result", {"text/plain": "4.0"}, execution_count=1)]
    forged.source = "4.0"
    forged.metadata.nbgrader.points = 0.5
    forged.metadata.course = {"group": "graph"}
    course.grade = lambda job: verdict(notebook)
    course.submit("mallory", notebook)
    assert course.autograde("mallory")["success"]
    assert course.grades("mallory") == RECORDED


def remove_grade_cells(notebook: NotebookNode) -> None:
    notebook.cells = [cell for cell in notebook.cells if not cell.id.startswith("g-")]


def remove_all_cells(notebook: NotebookNode) -> None:
    notebook.cells = []


def copy_grade_cells(notebook: NotebookNode) -> None:
    notebook.cells += copy.deepcopy([cell for cell in notebook.cells if cell.id.startswith("g-")])


def retype(notebook: NotebookNode) -> None:
    for index, old in enumerate(notebook.cells):
        if old.id.startswith("g-"):
            notebook.cells[index] = new_markdown_cell("pass", id=old.id, metadata=old.metadata)


def unmark(notebook: NotebookNode) -> None:
    for cell in notebook.cells:
        cell.metadata.pop("nbgrader", None)


def claim_solution(notebook: NotebookNode) -> None:
    for cell in notebook.cells:
        if "nbgrader" in cell.metadata:
            cell.metadata.nbgrader.update(solution=True, locked=False, points=100)


def strange_marks(notebook: NotebookNode) -> None:
    for index, marks in enumerate(({}, [], "x", {"grade": True}, {"grade_id": 7, "grade": True}, {"grade_id": []})):
        notebook.cells.append(new_code_cell("1", id=f"odd{index}", metadata={"nbgrader": marks}))


def extra_grade(notebook: NotebookNode) -> None:
    extra = copy.deepcopy(cell(notebook, "g-graph"))
    extra.id, extra.metadata.nbgrader.grade_id = "more", "grade-more"
    notebook.cells.append(extra)


def old_schema(notebook: NotebookNode) -> None:
    for cell in notebook.cells:
        if "nbgrader" in cell.metadata:
            cell.metadata.nbgrader["schema_version"] = 99


@pytest.mark.parametrize(
    "tamper",
    [
        remove_grade_cells,
        remove_all_cells,
        copy_grade_cells,
        retype,
        unmark,
        claim_solution,
        strange_marks,
        extra_grade,
        old_schema,
    ],
)
def test_a_tampered_notebook_neither_gains_points_nor_shrinks_the_maximum(
    tamper: Callable[[NotebookNode], None], course: Any, verdict: Callable[..., Any]
) -> None:
    notebook = course.released
    tamper(notebook)
    course.grade = lambda job: verdict()
    course.submit("mallory", notebook)
    response = course.autograde("mallory")
    assert response["success"], response
    assert course.grades("mallory") == RECORDED
    assert "(Score: 4.0 / 7.0)" in course.feedback("mallory")
    assert "SECRET" not in course.feedback("mallory")


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b"\xff\xfe\x00", b"[]", b'{"cells": 7, "nbformat": 4, "nbformat_minor": 5, "metadata": {}}', b"null"],
    ids=["empty", "cut", "binary", "list", "cells", "null"],
)
def test_a_file_that_is_not_a_notebook_gets_the_graders_verdict(
    data: bytes, course: Any, verdict: Callable[..., Any]
) -> None:
    course.grade = lambda job: verdict()
    course.submit("bob", data)
    response = course.autograde("bob")
    assert response["success"], response
    assert course.grades("bob") == RECORDED


def test_an_ungraded_submission_fails_and_no_score_is_recorded(course: Any, verdict: Callable[..., Any]) -> None:
    course.grade = lambda job: verdict(status=Status.NOT_GRADED, checks=())
    course.submit("carol", course.released)
    response = course.autograde("carol")
    assert not response["success"]
    assert "carol: not graded, no score was recorded." in response["log"]
    assert course.grades("carol") == {"grade-graph": (None, 3.0, True), "grade-reaction": (None, 4.0, True)}
    assert not (course.root / "autograded" / "carol" / "tiny").exists()


def test_when_the_grader_fails_the_old_score_stays_and_manual_grading_is_requested(
    course: Any, verdict: Callable[..., Any]
) -> None:
    course.submit("dave", course.released)
    course.grade = lambda job: verdict()
    assert course.autograde("dave")["success"]

    def fail(*args: Any, **kwargs: Any) -> Any:
        raise IsolationError("this machine cannot isolate submissions")

    course.grade = fail
    response = course.autograde("dave", force=True)
    assert not response["success"]
    assert "this machine cannot isolate submissions" in response["log"]
    assert course.grades("dave") == {name: (*grade[:2], True) for name, grade in RECORDED.items()}
    course.grade = lambda job: verdict()
    assert course.autograde("dave", force=True)["success"]
    assert course.grades("dave") == RECORDED


def test_groups_that_do_not_match_the_cells_are_refused(
    course: Any, verdict: Callable[..., Any], make_check: Callable[..., Check]
) -> None:
    checks = (CheckResult.of(make_check("starts", "It starts.", 3, "graph"), Outcome.PASSED),)
    course.grade = lambda job: verdict(checks=checks, max_score=3.0)
    course.submit("erin", course.released)
    response = course.autograde("erin")
    assert not response["success"]
    assert "have the groups ['graph', 'reaction'], but its suite has ['graph']" in response["log"]
    assert course.grades("erin")["grade-reaction"] == (None, 4.0, True)


def test_points_that_do_not_match_the_cell_are_refused(
    course: Any, verdict: Callable[..., Any], make_check: Callable[..., Check]
) -> None:
    checks = tuple(
        CheckResult.of(make_check(group, "It works.", 5, group), Outcome.PASSED) for group in ("graph", "reaction")
    )
    course.grade = lambda job: verdict(checks=checks, max_score=10.0)
    course.submit("frank", course.released)
    response = course.autograde("frank")
    assert not response["success"]
    assert "the cell of group 'graph' is worth 3 points, but its checks are worth 5" in response["log"]


def test_code_in_a_students_notebook_does_not_run_in_feedback(course: Any, verdict: Callable[..., Any]) -> None:
    notebook = course.released
    notebook.cells += [
        new_markdown_cell("<script>alert('markdown')</script> [x](javascript:alert('link')) <img src=x onerror=a()>"),
        new_code_cell("'</pre><script>alert(1)</script>'", id="code", metadata={"tags": ["x'><script>tag"]}),
    ]
    executed = copy.deepcopy(notebook)
    cell(executed, "code").outputs = [
        new_output("display_data", {"text/html": "<script>html</script>", "text/plain": "<script>plain</script>"}),
        new_output("display_data", {"application/javascript": "js()", "image/svg+xml": "<svg onload='svg()'/>"}),
        new_output(
            "display_data", {"image/png": "'><script>png</script>"}, metadata={"image/png": {"width": "1 on=x"}}
        ),
        new_output("error", ename="<script>", evalue="<script>", traceback=["<script>trace</script>"]),
    ]
    course.grade = lambda job: verdict(executed)
    course.submit("mallory", notebook)
    assert course.autograde("mallory")["success"]
    html = course.feedback("mallory")
    for injected in ("<script>alert", "<script>html", "<script>plain", "<script>tag", "<script>png", "<script>trace"):
        assert injected not in html
    assert '<img src="x" onerror' not in html
    assert "svg()" not in html
    assert "js()" not in html
    assert 'href="javascript' not in html
    assert "&lt;script&gt;plain&lt;/script&gt;" in html
