"""Writes results as tables on a terminal."""

from __future__ import annotations

import math
import shutil
import textwrap

from autograder.plain_text import visible
from autograder.result.causes import causes, dearest
from autograder.result.model import Result, Status
from autograder.suite import Outcome


def failure_summary(result: Result) -> str:
    """Return one sentence that says why points are missing: the failure that costs most."""
    if result.status is not Status.GRADED or result.build is None or not result.build.ok:
        return result.diagnosis.sentence
    first = dearest(causes(result.checks, result.diagnosis.sentence))
    failed = sum(check.outcome is Outcome.FAILED for check in result.checks)
    more = f" (and {failed - 1} more)" if failed > 1 else ""
    return f"{first.message or first.title}{more}" if first else ""


def table(rows: list[tuple[str, str, str]], headings: tuple[str, str, str]) -> str:
    """Return a table of three columns; the last one is wrapped. No text of a row can begin a line of its own."""
    rows = [(visible(name, line=True), visible(mark, line=True), visible(text)) for name, mark, text in rows]
    first = max(len(row[0]) for row in [headings, *rows])
    second = max(len(row[1]) for row in [headings, *rows])
    width = max(40, shutil.get_terminal_size((120, 24)).columns - first - second - 4)
    lines = []
    for index, (name, mark, text) in enumerate([headings, *rows]):
        wrapped = textwrap.wrap(text, width) or [""]
        lines.append(f"{name:<{first}}  {mark:>{second}}  {wrapped[0]}".rstrip())
        lines += [" " * (first + second + 4) + line for line in wrapped[1:]]
        if index == 0:
            lines.append("-" * (first + second + 4 + min(width, 60)))
    return "\n".join(lines)


def score_text(result: Result) -> str:
    """Return the score of a result as text, or why there is none."""
    if result.status is not Status.GRADED:
        return result.status.words
    return f"{result.score:g}/{result.max_score:g} = {math.floor(result.percent)} %"  # never rounded up to all
