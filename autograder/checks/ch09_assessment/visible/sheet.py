"""Question 1: each question has a letter. No visible check reveals whether the letter is correct."""

from __future__ import annotations

from autograder.checking import Workspace, check, expect, hint
from autograder.checks.ch09_assessment.support.contract import QUESTIONS
from autograder.checks.ch09_assessment.support.sheet import answers, expect_letter


@check(points=1, covers="sheet", group="choices")
@hint("A line is `q1: a`: the question, a colon, a space, one letter.", "A guess costs nothing; a gap earns nothing.")
def test_answered(workspace: Workspace) -> None:
    """Question 1: each question has an answer, one of four letters. Whether it is correct is not checked."""
    answers_by_question = answers(workspace)
    for question in QUESTIONS:
        expect_letter(answers_by_question, question)
    unknown_questions = sorted(set(answers_by_question) - set(QUESTIONS))
    expect(not unknown_questions, f"There is no question {', '.join(unknown_questions)[:80]}.")
