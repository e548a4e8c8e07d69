"""HTML: a feedback page for each submission, and a table with links to the pages."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autograder.report import feedback
from autograder.report.export.stored import per_student
from autograder.result.model import Result

FOLDER = True


def write(results: Sequence[Result], out: Path) -> Path:
    """Write `out/<student>/feedback.html` for each submission and `out/index.html`; return the latter."""
    for result, folder in per_student(results, out):
        feedback.write(result, folder, artifacts=result.folder)
    return feedback.write_summary(results, out)
