"""The assessment's choices: notebook and key have the same questions, and every wrong answer is explained."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.checks.ch09_assessment.hidden.questions import QUESTIONS
from autograder.checks.ch09_assessment.support import contract
from autograder.checks.ch09_assessment.support.sheet import answers, expect_letter, parse
from autograder.harness import Workspace
from autograder.ros import find
from autograder.suite import CheckFailed, suites

ASSIGNMENT = "09_assessment"


def test_the_notebook_asks_each_question_with_four_choices() -> None:
    text = "\n".join(cell.source for cell in Chapter(course_paths.chapter(ASSIGNMENT)).read().cells)
    questions = dict(re.findall(r"^\*\*(q\d+)\.\*\*.*?((?:\n- [a-d]\) [^\n]+)+)", text, re.MULTILINE | re.DOTALL))
    assert tuple(questions) == contract.QUESTIONS == tuple(QUESTIONS)
    for choices in questions.values():
        assert re.findall(r"^- ([a-d])\)", choices, re.MULTILINE) == list("abcd")


def test_every_objective_of_the_chapters_before_has_a_question() -> None:
    earlier = [name for name in suites.graded_assignments() if name < ASSIGNMENT]
    notebooks = [Chapter(course_paths.chapter(name)).read() for name in earlier]
    objectives = {entry["objective"] for notebook in notebooks for entry in notebook.metadata["course"]["objectives"]}
    assert {question.objective for question in QUESTIONS.values()} == objectives


@pytest.mark.parametrize("name", QUESTIONS)
def test_every_wrong_answer_is_explained_without_naming_the_right_one(name: str) -> None:
    question = QUESTIONS[name]
    assert {question.correct_letter, *question.explanations} == set("abcd")
    assert len(question.explanations) == 3
    for text in (question.title, *question.explanations.values(), *question.hints):
        assert not re.search(rf"(?<![\w.'/]){question.correct_letter}\)", text)
    assert len(set(question.hints)) == 2


def test_the_reference_contains_the_key_and_the_release_does_not() -> None:
    sheet = (course_paths.SOLUTIONS / contract.SHEET).read_text()
    assert parse(sheet) == {name: question.correct_letter for name, question in QUESTIONS.items()}
    released = in_form(Chapter(course_paths.chapter(ASSIGNMENT)).read(), Form.RELEASED)
    (cell,) = [cell for cell in released.cells if cell.id == "answers"]
    assert "still to be written" in cell.source
    assert parse(cell.source).keys().isdisjoint(QUESTIONS)


def test_each_letter_is_equally_often_the_correct_answer() -> None:
    letters = [question.correct_letter for question in QUESTIONS.values()]
    assert all(letters.count(letter) == 3 for letter in contract.LETTERS)


def test_each_choice_is_a_check_of_one_point() -> None:
    checks = [check for check in suites.hidden(ASSIGNMENT).checks if check.group == "choices"]
    assert [(check.id, check.points) for check in checks] == [(name, 1.0) for name in QUESTIONS]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("q1: a", {"q1": "a"}),
        ("Q1 :  'B'  # sure\n\n# q2: c\nnonsense\n- q3: d", {"q1": "b"}),
        ("'q1': a\n\"q2\" : 'b'", {"q1": "a", "q2": "b"}),
        ("q1: a\nq1: b", {"q1": "b"}),
        ("q1:", {"q1": ""}),
        ("q1: a or b", {"q1": "a or b"}),
        ("&a [*a, *a]: *a", {}),
    ],
)
def test_a_sheet_is_read_line_by_line(text: str, expected: dict[str, str]) -> None:
    assert parse(text) == expected


@pytest.mark.parametrize(
    ("answers", "message"),
    [({}, "There is no answer to q1: write a line `q1: LETTER`."), ({"q1": "e"}, "The answer to q1 is 'e', instead")],
)
def test_an_answer_that_is_not_a_letter_is_named(answers: dict[str, str], message: str) -> None:
    with pytest.raises(CheckFailed) as excinfo:
        expect_letter(answers, "q1")
    assert excinfo.value.message.startswith(message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "There is no ws/src/assessment/answers.yaml: run the cell that writes it."),
        ("raise NotImplementedError('...')", "assessment/answers.yaml is still to be written: replace the line raise"),
        ("q1: a\n" * 20_000, "assessment/answers.yaml is far larger than 12 letters."),
    ],
)
def test_a_sheet_that_cannot_be_read_is_explained(text: str | None, message: str, tmp_path: Path) -> None:
    sheet = tmp_path / "src" / contract.SHEET
    sheet.parent.mkdir(parents=True)
    if text is not None:
        sheet.write_text(text)
    with pytest.raises(CheckFailed) as excinfo:
        answers(Workspace(tmp_path, find(), tmp_path / "scratch"))
    assert excinfo.value.message.startswith(message)


def test_a_fan_averages_the_temperatures_that_it_has() -> None:
    assert contract.averages([1.0, 2.0, 6.0], window=2) == [1.0, 1.5, 4.0]
