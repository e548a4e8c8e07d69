"""Other answers: for each submission with full marks, a page with other correct answers and how they differ."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autograder.report.export.stored import per_student
from autograder.report.feedback.pages import write_page
from autograder.report.other_answers import other_answers
from autograder.result.model import Result, Status

FOLDER = True
PAGE = "other_answers.html"


def write(results: Sequence[Result], out: Path) -> Path:
    """Write `out/<student>/other_answers.html` for each submission with full marks. Return `out`.

    Raises:
        UsageError: an assignment has no other answers to show.
    """
    for result, folder in per_student(results, out):
        if result.status is Status.GRADED and result.max_score and result.score == result.max_score:
            values = {"assignment": result.assignment, "answers": other_answers(result.assignment)}
            write_page(folder / PAGE, "other_answers.html.j2", **values)
    return out
