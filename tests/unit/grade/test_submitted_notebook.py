"""Cells that a student may not change are restored in a submitted notebook."""

from __future__ import annotations

import copy
import json
from typing import Any

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.grade import submitted_notebook


def _marked(cell: NotebookNode, name: str, **marks: Any) -> NotebookNode:
    base = {"grade": False, "solution": False, "locked": False, "task": False, "schema_version": 3}
    cell.metadata.nbgrader = {**base, "grade_id": name, **marks}
    return cell


def _exercise(source: str = "# YOUR CODE HERE") -> NotebookNode:
    return _marked(new_code_cell(source), "exercise", solution=True)


def _grade_cell(source: str = "grade('02_nodes', 'graph')", points: float = 9.0) -> NotebookNode:
    return _marked(new_code_cell(source), "grade-graph", grade=True, locked=True, points=points)


def _source() -> NotebookNode:
    given = _marked(new_markdown_cell("Read this."), "given", locked=True)
    return new_notebook(
        cells=[given, _exercise(), _grade_cell()],
        metadata={"kernelspec": {"name": "python3", "display_name": "Python 3"}},
    )


def _cells(notebook: NotebookNode) -> dict[str, NotebookNode]:
    return {submitted_notebook.grade_id(cell): cell for cell in notebook.cells if submitted_notebook.grade_id(cell)}


def _is_as_released(notebook: NotebookNode) -> bool:
    cells, expected = _cells(notebook), _cells(_source())
    claims = [submitted_notebook.grade_id(cell) for cell in notebook.cells if submitted_notebook.grade_id(cell)]
    return sorted(claims) == sorted(expected) and all(
        cells[name].metadata == cell.metadata and cells[name].cell_type == cell.cell_type
        for name, cell in expected.items()
    )


def test_a_student_s_answer_is_kept() -> None:
    submitted = _source()
    submitted.cells[1].source = "answer = 42"
    submitted.cells.insert(0, new_code_cell("scratch = 1"))
    restored = submitted_notebook.restore(submitted, _source())
    assert _is_as_released(restored)
    assert _cells(restored)["exercise"].source == "answer = 42"
    assert restored.cells[0].source == "scratch = 1"


def test_a_changed_locked_cell_is_restored() -> None:
    submitted = _source()
    submitted.cells[0].source = "Nothing to read."
    submitted.cells[2] = _grade_cell("print(100)", points=100.0)
    restored = submitted_notebook.restore(submitted, _source())
    assert _is_as_released(restored)
    assert _cells(restored)["grade-graph"].source == "grade('02_nodes', 'graph')"
    assert _cells(restored)["given"].source == "Read this."


def test_deleted_cells_are_added_again() -> None:
    restored = submitted_notebook.restore(new_notebook(cells=[_exercise("mine")]), _source())
    assert _is_as_released(restored)
    assert [cell.source for cell in restored.cells] == ["mine", "Read this.", "grade('02_nodes', 'graph')"]


def test_a_copy_of_a_graded_cell_loses_its_grade_id() -> None:
    submitted = _source()
    submitted.cells += [_grade_cell("copy"), _grade_cell("another")]
    restored = submitted_notebook.restore(submitted, _source())
    assert _is_as_released(restored)
    assert [submitted_notebook.grade_id(cell) for cell in restored.cells[3:]] == ["", ""]


def test_a_retyped_cell_gets_its_type_back_and_keeps_an_answer() -> None:
    submitted = _source()
    submitted.cells[1] = _marked(new_markdown_cell("answer = 42"), "exercise", solution=True)
    submitted.cells[2] = _marked(new_markdown_cell("gone"), "grade-graph", grade=True, locked=True, points=9.0)
    restored = submitted_notebook.restore(submitted, _source())
    assert _is_as_released(restored)
    assert _cells(restored)["exercise"].source == "answer = 42"


def test_unlocking_a_cell_or_giving_a_new_one_points_has_no_effect() -> None:
    submitted = _source()
    submitted.cells[2] = _marked(new_code_cell("mine"), "grade-graph", grade=True, solution=True, points=1)
    submitted.cells.append(_marked(new_code_cell("bonus"), "grade-bonus", grade=True, points=50))
    restored = submitted_notebook.restore(submitted, _source())
    assert _is_as_released(restored)
    assert restored.cells[3].metadata == {}


def test_outputs_and_the_notebook_s_own_metadata_are_dropped() -> None:
    submitted = _source()
    submitted.cells[2].outputs = [new_output("stream", text="51.0")]
    submitted.metadata = {"kernelspec": {"name": "evil", "display_name": "Evil"}, "widgets": {}}
    restored = submitted_notebook.restore(submitted, _source())
    assert _cells(restored)["grade-graph"].outputs == []
    assert restored.metadata == _source().metadata


def test_an_answer_whose_metadata_was_dropped_is_recognised_by_its_id_or_the_question_above_it() -> None:
    for keep_ids in (True, False):
        source = _source()
        source.cells[2:2] = [
            new_markdown_cell("## Why?\n\nSay it."),
            _marked(new_markdown_cell(""), "why", solution=True),
        ]
        submitted = copy.deepcopy(source)
        submitted.cells[1].source, submitted.cells[3].source = "answer = 42", "Because."
        submitted.cells[2].source = "## Why?"  # as released, without its mark scheme
        for cell in submitted.cells:
            cell.metadata = {}
            cell.id = cell.id if keep_ids else f"other-{cell.id}"
        answers = _cells(submitted_notebook.restore(submitted, source))
        assert (answers["exercise"].source, answers["why"].source) == ("answer = 42", "Because.")


def test_neither_notebook_is_changed_in_place() -> None:
    submitted, source = new_notebook(cells=[_exercise("mine")]), _source()
    before = (json.dumps(submitted), json.dumps(source))
    restored = submitted_notebook.restore(submitted, source)
    restored.cells[1].source = "changed"
    assert (json.dumps(submitted), json.dumps(source)) == before


@pytest.mark.parametrize("claim", [None, 7, ["grade-graph"], {"a": 1}, ""])
def test_a_grade_id_of_another_type_is_ignored(claim: object) -> None:
    cell = new_code_cell("x", metadata={"nbgrader": {"grade_id": claim}})
    assert submitted_notebook.grade_id(cell) == ""
    assert _is_as_released(submitted_notebook.restore(new_notebook(cells=[cell]), _source()))


def test_a_notebook_is_read_with_any_line_ends() -> None:
    text = nbformat.writes(_source()).replace("\n", "\r\n").encode()
    assert len(submitted_notebook.read(text, "a.ipynb").cells) == 3


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"not json",
        b"[]",
        b"42",
        b"\xff\xfe\x00\x00",
        b'{"cells": [], "nbformat": 99, "nbformat_minor": 0, "metadata": {}}',
        b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": [{"cell_type": "magic"}]}',
        b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": 5}',
        b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}}',
        b"[" * 100_000,
    ],
)
def test_a_file_that_is_not_a_notebook_is_named_with_the_remedy(data: bytes) -> None:
    with pytest.raises(StudentError, match=r"02_nodes.ipynb cannot be read as a notebook") as excinfo:
        submitted_notebook.read(data, "02_nodes.ipynb")
    assert excinfo.value.diagnosis.kind is Kind.UNREADABLE
    assert "save it and hand it in again" in excinfo.value.diagnosis.sentence


def test_a_notebook_of_thousands_of_cells_is_refused() -> None:
    notebook = new_notebook(cells=[new_markdown_cell("") for _ in range(submitted_notebook.MAX_CELLS + 1)])
    with pytest.raises(StudentError, match="has 501 cells: at most 500 are allowed"):
        submitted_notebook.read(nbformat.writes(notebook).encode(), "a.ipynb")
