"""Question 1: each choice is a check of its own, and says why a wrong answer is wrong."""

from __future__ import annotations

from dataclasses import dataclass

from autograder.checking import CheckRow, Workspace, check_each_row, expect, group
from autograder.checks.ch09_assessment.hidden.questions import QUESTIONS, Question
from autograder.checks.ch09_assessment.support.sheet import answers, expect_letter


@dataclass(frozen=True, kw_only=True)
class Choice(CheckRow):
    """The check of one question."""

    question: Question


CHOICES = [
    Choice(
        id=name,
        title=f"Question 1.{name[1:]}: {asked.title}",
        points=1,
        hints=asked.hints,
        doc=asked.doc,
        question=asked,
        covers="choices",
    )
    for name, asked in QUESTIONS.items()
]


@check_each_row(group("choices"), CHOICES)
def letter_is_right(choice: Choice, workspace: Workspace) -> None:
    """Compare the letter that was given with the right one."""
    letter = expect_letter(answers(workspace), choice.id)
    expect(letter == choice.question.right, f"You chose {letter}. {choice.question.wrong.get(letter, '')}")
