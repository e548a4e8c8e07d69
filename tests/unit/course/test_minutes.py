"""The time that a chapter promises is counted from what there is to read, run and write."""

from __future__ import annotations

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder.course.minutes import Effort, effort, promise, told, wrong_promise

EXERCISE = """%%writefile turn.py
def turn():
    # BEGIN SOLUTION
    speed = 0.5

    return speed
    # END SOLUTION
"""
BOOK = new_notebook(cells=[new_markdown_cell("# Turn around"), new_code_cell(EXERCISE), new_code_cell("turn()")])


def test_words_cells_and_the_lines_of_answers_are_counted() -> None:
    assert effort(BOOK) == Effort(words=3, cells=2, lines=2)


def test_the_promise_has_a_time_to_read_and_a_time_to_write() -> None:
    assert promise(Effort(words=2400, cells=20, lines=50)) == (
        "40 minutes to read and run, 60 minutes for the exercises"
    )


@pytest.mark.parametrize(
    ("minutes", "words"),
    [(1.0, "5 minutes"), (43.0, "45 minutes"), (90.0, "90 minutes"), (110.0, "2 hours"), (148.0, "2½ hours")],
)
def test_a_time_is_told_in_steps(minutes: float, words: str) -> None:
    assert told(minutes) == words


def test_a_chapter_that_promises_another_time_is_found() -> None:
    (finding,) = wrong_promise("turn.ipynb", BOOK)
    assert "5 minutes to read and run, 5 minutes for the exercises" in str(finding)
    honest = new_markdown_cell("# Turn around\n\n*5 minutes to read\nand run, 5 minutes for the exercises.*")
    assert wrong_promise("turn.ipynb", new_notebook(cells=[honest, *BOOK.cells[1:]])) == []
