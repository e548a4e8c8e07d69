"""CSV: a row for each submission."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from autograder.report.feedback.text import one_line
from autograder.result.model import Result, Status

FOLDER = False
# Characters at which a spreadsheet may split a cell if it assumes another separator.
_SEPARATOR = re.compile(r"([;|\t])")


def write(results: Sequence[Result], out: Path, extra_cells: Mapping[str, Mapping[str, str | float]] = {}) -> Path:
    """Write a row for each result, with a column for each check and the points that it earned.

    `extra_cells` contains additional cells by student and heading. The file is UTF-8 with commas, and every cell is
    quoted as in RFC 4180. A submission that was not graded has no score.
    """
    rows = [{**_row(result), **extra_cells.get(result.student, {})} for result in results]
    with out.open("w", encoding="utf-8", newline="") as file:
        columns = list(dict.fromkeys(name for row in rows for name in row))
        writer = csv.DictWriter(file, columns, restval="", quoting=csv.QUOTE_ALL)
        writer.writeheader()
        writer.writerows(rows)
    return out


def _row(result: Result) -> dict[str, str | float]:
    graded = result.status is Status.GRADED
    return {
        "assignment": _text(result.assignment),
        "student": _text(result.student),
        "status": result.status.value,
        "score": result.score if graded else "",
        "max_score": result.max_score,
        "percent": round(result.percent, 2) if graded else "",
        "diagnosis": result.diagnosis.kind.value,
        "reason": _text(result.diagnosis.sentence),
        "seed": result.seed,
        "suite_version": _text(result.suite_version),
        "isolation": _text(result.isolation),
        "submission_sha256": result.submission_sha256,
        "started": _text(result.started),
        "seconds": result.seconds,
        **{f"check {check.id}": check.points if graded else "" for check in result.checks},
    }


def _text(value: str) -> str:
    """Return the text on one line. A quote before every part that starts with =, +, - or @ prevents formulas."""
    parts = _SEPARATOR.split(one_line(value))
    return "".join(f"'{part}" if part.lstrip(" \"'").startswith(("=", "+", "-", "@")) else part for part in parts)
