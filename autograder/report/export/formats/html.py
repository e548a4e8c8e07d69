"""HTML: the feedback page of each submission, and a table with links to them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autograder.report import feedback
from autograder.report.export.stored import Stored, per_student

FOLDER = True


def write(stored: Sequence[Stored], out: Path) -> Path:
    """Write `out/<student>/feedback.html` for each submission and `out/index.html`; return the latter."""
    for item, folder in per_student(stored, out):
        feedback.write(item.result, folder, artifacts=item.folder)
    return feedback.write_summary([item.result for item in stored], out)
