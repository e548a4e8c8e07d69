"""The sheet of answers to question 1: one letter for each of its choices."""

from __future__ import annotations

import re
from pathlib import Path

from autograder.checking import CheckFailed, Workspace, expect
from autograder.checks.ch09_assessment.support.contract import LETTERS, QUESTIONS, SHEET

MAX_BYTES = 64 * 1024  # the largest sheet that is read
_QUESTION = re.compile(r"\w+")
QUOTES = ("'", '"')


def parse(text: str) -> dict[str, str]:
    """Read the lines `question: answer`, and return the answers by question, in lower case.

    If a question occurs twice, its last answer counts.
    """
    answers_by_question = {}
    for line in text.splitlines():
        question, colon, answer = (part.strip() for part in line.partition("#")[0].partition(":"))
        question, answer = _unquote(question), _unquote(answer)
        if colon and _QUESTION.fullmatch(question) and not any(quote in answer for quote in QUOTES):
            answers_by_question[question.lower()] = answer.lower()
    return answers_by_question


def _unquote(text: str) -> str:
    return text[text.startswith(QUOTES) : len(text) - text.endswith(QUOTES)].strip()


def answers(workspace: Workspace) -> dict[str, str]:
    """Return a student's answers by question.

    Raises:
        CheckFailed: there is no sheet, or it cannot be read.
    """
    path: Path = workspace.root / "src" / SHEET
    if path.is_symlink() or not path.is_file():
        raise CheckFailed(f"There is no ws/src/{SHEET}: run the cell that writes it.")
    data = path.read_bytes()[: MAX_BYTES + 1]
    expect(len(data) <= MAX_BYTES, f"{SHEET} is far larger than {len(QUESTIONS)} letters.")
    text = data.decode(errors="replace")
    expect(
        "NotImplementedError" not in text,
        f"{SHEET} is still to be written: replace the line raise NotImplementedError(...) with letters.",
    )
    return parse(text)


def expect_letter(answers_by_question: dict[str, str], question: str) -> str:
    """Return the letter that answers a question; fail the check unless it is one of the four letters."""
    expect(
        bool(answers_by_question.get(question)), f"There is no answer to {question}: write a line `{question}: LETTER`."
    )
    letter = answers_by_question[question]
    expect(
        len(letter) == 1 and letter in LETTERS,
        f"The answer to {question} is {letter[:40]!r}, instead of one letter of {', '.join(LETTERS)}.",
    )
    return letter
