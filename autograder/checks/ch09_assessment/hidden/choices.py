"""Question 1: each choice is a check of its own, and says why a wrong answer is wrong."""

from __future__ import annotations

from collections.abc import Callable

from autograder.checks import check, expect
from autograder.checks.ch09_assessment.hidden.questions import QUESTIONS, Question
from autograder.checks.ch09_assessment.visible.sheet import answers, expect_letter
from autograder.harness import Workspace


def _check(name: str, question: Question) -> Callable[[Workspace], None]:
    def test(workspace: Workspace) -> None:
        letter = expect_letter(answers(workspace), name)
        expect(letter == question.right, f"You chose {letter}. {question.wrong.get(letter, '')}")

    test.__name__ = f"test_{name}"
    test.__doc__ = f"Question 1.{name[1:]}: {question.title}"
    return check(points=1, group="choices", hints=question.hints, doc=question.doc)(test)


globals().update({f"test_{name}": _check(name, question) for name, question in QUESTIONS.items()})
