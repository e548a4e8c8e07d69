"""Names a folder for each submission, for the formats that write several files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.export.stored import Stored


def per_student(stored: Sequence[Stored], out: Path) -> list[tuple[Stored, Path]]:
    """Pair each result with `out/<student>`.

    Raises:
        UsageError: a student has two results, or a student's name cannot be the name of a folder.
    """
    pairs: dict[str, tuple[Stored, Path]] = {}
    for item in stored:
        student = item.result.student
        if student in ("", ".", "..") or "/" in student or "\0" in student:
            raise UsageError(f"the student {student!r} cannot be the name of a folder; use a format without folders")
        if student in pairs:
            raise UsageError(f"the student {student!r} has two results; export one assignment at a time")
        pairs[student] = (item, out / student)
    return list(pairs.values())
