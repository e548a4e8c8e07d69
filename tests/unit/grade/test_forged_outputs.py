"""Reading what a notebook's sandbox reports, and a notebook's own metadata, takes seconds at most."""

from __future__ import annotations

import json
import time

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder.grade import submitted_notebook
from autograder.grade.run_notebook import MAX_VALUES, read_answer


def cell(index: int, outputs: object) -> bytes:
    return json.dumps({"event": "cell", "index": index, "outputs": outputs, "execution_count": 1}).encode() + b"\n"


def stream(text: str) -> dict[str, str]:
    return {"output_type": "stream", "name": "stdout", "text": text}


@pytest.mark.parametrize(
    "flood",
    [
        cell(1, [{"output_type": "display_data", "data": {"a": [{}] * (2 * MAX_VALUES)}, "metadata": {}}]),
        cell(1, [stream("")] * MAX_VALUES),
        cell(1, []) * 100_000,
        b"x\n" * 2_000_000,
    ],
    ids=["values", "outputs", "cells", "lines"],
)
def test_an_endless_answer_is_read_quickly_and_the_part_before_it_counts(flood: bytes) -> None:
    started_at = time.process_time()
    answer = read_answer(cell(0, [stream("mine")]) + flood)
    assert time.process_time() - started_at < 10  # an answer of the maximum size once took up to nine minutes
    assert answer.cells[0].outputs[0].text == "mine"


def test_metadata_of_a_students_own_cells_are_removed() -> None:
    source = new_notebook(cells=[new_code_cell("1", metadata={"nbgrader": {"grade_id": "wall", "locked": True}})])
    cells = [new_code_cell("2", metadata={"more": [{"a": 1}]}), new_markdown_cell("3", metadata={"nbgrader": {"x": 1}})]
    restored = submitted_notebook.restore(new_notebook(cells=cells), source)
    assert [cell.metadata for cell in restored.cells] == [{}, {}, source.cells[0].metadata]
