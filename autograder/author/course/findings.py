"""Problems in the files of a course, and their locations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from autograder import course_paths


@dataclass(frozen=True)
class Finding:
    """A problem in a file, and how to fix it.

    Attributes:
        file: the name of the notebook, or the path of another file, relative to the course's folder.
        cell: the id of the notebook's cell, or None if the problem does not concern a single cell.
        message: the problem and the fix.
        line: the line of the file, from 1, or None if the problem does not concern a single line.
    """

    file: str
    cell: str | None
    message: str
    line: int | None = None

    def __str__(self) -> str:
        line = "" if self.line is None else f":{self.line}"
        cell = "" if self.cell is None else f", cell {self.cell!r}"
        return f"{self.file}{line}{cell}: {self.message}"


def display_path(path: Path) -> str:
    """Return a path as findings show it: relative to the course's folder if it is inside that folder."""
    root = course_paths.course().root
    return str(path.relative_to(root) if path.is_relative_to(root) else path)


def outdated_file(path: Path, text: str) -> Iterator[Finding]:
    """Yield a finding unless the file that `autograder course tables` writes exists and has this text."""
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        yield Finding(display_path(path), None, "is out of date: run `autograder course tables`", 1)


# A finding, and a function that fixes it in place (None if the author has to fix it).
Difference = tuple[Finding, Callable[[], None] | None]
