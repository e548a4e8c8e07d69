"""Texts and number formats for the pages."""

from __future__ import annotations

from autograder.plain_text import clean
from autograder.result.model import Result, Status

NOT_GRADED = "The grader itself failed. This is not a zero."


def no_mark(result: Result) -> str:
    """Return why a result has no mark: the grader failed, or the submission is unclear."""
    return clean(result.diagnosis.sentence) if result.status is Status.UNCLEAR else NOT_GRADED


def one_line(text: str) -> str:
    """Return cleaned `text` on one line, with single spaces."""
    return " ".join(clean(text).split())


def number(value: float) -> str:
    """Format points with at most two decimals: `3`, `2.5`, `0.33`."""
    return f"{round(value, 2):g}" if abs(value) < 1e5 else f"{value:.0f}"
