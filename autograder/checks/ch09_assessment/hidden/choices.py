"""Question 1: a check for each choice, with an explanation of why a wrong answer is wrong."""

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
        title=f"Question 1.{name[1:]}: {question.title}",
        points=1,
        hints=question.hints,
        doc=question.doc,
        question=question,
        covers="choices",
    )
    for name, question in QUESTIONS.items()
]


@check_each_row(group("choices"), CHOICES)
def expect_correct_letter(choice: Choice, workspace: Workspace) -> None:
    """Fail the check unless the given letter is the correct one."""
    letter = expect_letter(answers(workspace), choice.id)
    explanation = choice.question.explanations.get(letter, "")
    expect(letter == choice.question.correct_letter, f"You chose {letter}. {explanation}")
