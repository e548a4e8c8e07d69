"""The answers that people wrote from the notebooks alone still fit the references and the notebooks."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from autograder import course_paths
from tests.written_answers import ASSIGNMENTS, FOLDER, right_answers, wrong_answers


def _words(text: str) -> str:
    return " ".join(text.split())


def test_each_chapter_of_the_textbook_has_written_answers() -> None:
    assert {f"{number:02}" for number in range(1, 10)} <= {assignment[:2] for assignment in ASSIGNMENTS}


@pytest.mark.parametrize("assignment", ASSIGNMENTS)
def test_each_wrong_answer_differs_from_the_reference_and_quotes_the_notebook(assignment: str, tmp_path: Path) -> None:
    notebook = course_paths.CHAPTERS / assignment / f"{assignment}.ipynb"
    text = _words("\n".join("".join(cell["source"]) for cell in json.loads(notebook.read_text())["cells"]))
    for answer in wrong_answers(assignment):
        assert _words(answer.sentence) in text, answer.name
        answer.write(tmp_path / answer.name)


@pytest.mark.parametrize("assignment", ASSIGNMENTS)
def test_each_right_answer_has_files_of_its_own(assignment: str, tmp_path: Path) -> None:
    answers = right_answers(assignment)
    assert {answer.folder for answer in answers} == {path for path in (FOLDER / assignment).iterdir() if path.is_dir()}
    for answer in answers:
        answer.write(tmp_path / answer.name)
        assert any(path.is_file() for path in answer.folder.rglob("*"))
