"""The time that a chapter states is estimated from what students read, run and write."""

from __future__ import annotations

import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder.author.course.sync import Chapter, chapters
from autograder.author.course.workload import Effort, duration_text, effort, outdated_time_sentence, time_sentence

from .notebooks import code, prose, solution

EXERCISE = """%%writefile turn.py
def turn():
    # BEGIN SOLUTION
    speed = 0.5

    return speed
    # END SOLUTION
"""
BOOK = new_notebook(cells=[new_markdown_cell("# Turn around"), new_code_cell(EXERCISE), new_code_cell("turn()")])


def test_words_cells_and_the_lines_of_answers_are_counted() -> None:
    counted = effort(BOOK)
    assert counted == Effort(words=3, cells=2, lines=2, longest_reading=counted.longest_reading)
    assert counted.longest_reading == pytest.approx(2 + 3 / 200)


def test_the_longest_time_without_anything_to_write_is_counted() -> None:
    write, later_exercise = (code(EXERCISE, name, nbgrader=solution(name)) for name in ("turn", "again"))
    run, first, second = code("turn()", "run"), prose("word " * 100, "first"), prose("word " * 400, "second")
    notebook = new_notebook(cells=[first, write, run, second, later_exercise])
    assert effort(notebook).longest_reading == pytest.approx(1 + 2.0)


@pytest.mark.parametrize("chapter", chapters(), ids=lambda chapter: chapter.assignment)
def test_a_student_reads_and_runs_for_at_most_30_minutes_before_writing_something(chapter: Chapter) -> None:
    assert effort(chapter.read()).longest_reading <= 30.0


def test_the_stated_time_has_a_part_to_read_and_a_part_to_write() -> None:
    assert time_sentence(Effort(words=2400, cells=20, lines=50)) == (
        "40 minutes to read and run, 60 minutes for the exercises"
    )


@pytest.mark.parametrize(
    ("minutes", "words"),
    [(1.0, "5 minutes"), (43.0, "45 minutes"), (90.0, "90 minutes"), (110.0, "2 hours"), (148.0, "2½ hours")],
)
def test_a_duration_is_rounded_to_steps(minutes: float, words: str) -> None:
    assert duration_text(minutes) == words


@pytest.mark.promise("The notebook's first cell says how long a beginner takes")
def test_a_chapter_that_states_a_wrong_time_is_reported() -> None:
    (finding,) = outdated_time_sentence("turn.ipynb", BOOK)
    assert "5 minutes to read and run, 5 minutes for the exercises" in str(finding)
    correct = new_markdown_cell("# Turn around\n\n*5 minutes to read\nand run, 5 minutes for the exercises.*")
    assert outdated_time_sentence("turn.ipynb", new_notebook(cells=[correct, *BOOK.cells[1:]])) == []
