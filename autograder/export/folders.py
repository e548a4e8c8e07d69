"""A folder for each submission below one folder, for the formats that write more than one file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.export.stored import Stored


def per_student(stored: Sequence[Stored], out: Path) -> list[tuple[Stored, Path]]:
    """Pair each result with `out/<student>`.

    Raises:
        UsageError: two results are of the same student, or a student's name cannot name a folder.
    """
    pairs: dict[str, tuple[Stored, Path]] = {}
    for item in stored:
        student = item.result.student
        if student in ("", ".", "..") or "/" in student or "\0" in student:
            raise UsageError(f"the student {student!r} cannot name a folder; export this result in another format")
        if student in pairs:
            raise UsageError(f"two results are of the student {student!r}; export one assignment at a time")
        pairs[student] = (item, out / student)
    return list(pairs.values())
