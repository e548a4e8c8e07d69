"""Formats results as tables for a terminal."""

from __future__ import annotations

import math
import shutil
import textwrap
from collections.abc import Sequence

from autograder.plain_text import visible
from autograder.result.causes import causes, costliest_failure
from autograder.result.model import Result, Status
from autograder.suite import Outcome


def failure_summary(result: Result) -> str:
    """Return a sentence with the main reason for lost points: the failure that costs the most."""
    if result.status is not Status.GRADED or result.build is None or not result.build.ok:
        return result.diagnosis.sentence
    costliest = costliest_failure(causes(result.checks, result.diagnosis.sentence))
    failure_count = sum(check.outcome is Outcome.FAILED for check in result.checks)
    others = f" (and {failure_count - 1} more)" if failure_count > 1 else ""
    return f"{costliest.message or costliest.title}{others}" if costliest else ""


def table(rows: Sequence[Sequence[str]], headings: Sequence[str]) -> str:
    """Return a table as text.

    The first column is left-aligned, the middle ones are right-aligned, and the last one is wrapped. The text of a row
    cannot start a new line.
    """
    cells = [list(headings), *([*(visible(text, line=True) for text in row[:-1]), visible(row[-1])] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*(row[:-1] for row in cells), strict=True)]
    indent = sum(widths) + 2 * len(widths)
    last_width = max(40, shutil.get_terminal_size((120, 24)).columns - indent)
    lines = []
    for index, (name, *middle, text) in enumerate(cells):
        wrapped_lines = textwrap.wrap(text, last_width) or [""]
        right_aligned = [cell.rjust(width) for cell, width in zip(middle, widths[1:], strict=True)]
        lines.append("  ".join([name.ljust(widths[0]), *right_aligned, wrapped_lines[0]]).rstrip())
        lines += [" " * indent + line for line in wrapped_lines[1:]]
        if index == 0:
            lines.append("-" * (indent + min(last_width, 60)))
    return "\n".join(lines)


def score_text(result: Result) -> str:
    """Return the score of a result as text, or the reason why it has none."""
    if result.status is not Status.GRADED:
        return result.status.words
    percent = math.floor(result.percent)  # rounded down, so that only full marks are 100 %
    return f"{result.score:g}/{result.max_score:g} = {percent} %"
