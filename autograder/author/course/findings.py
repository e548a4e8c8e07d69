"""A problem in a file of a course, and its location."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """A problem in a file, and how to fix it.

    Attributes:
        file: the name of the notebook, or the path of another file, relative to the course's folder.
        cell: the id of the notebook's cell, or None if it does not concern a single cell.
        message: the problem and the fix.
        line: the line of the file, from 1, or None if it does not concern a single line.
    """

    file: str
    cell: str | None
    message: str
    line: int | None = None

    def __str__(self) -> str:
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        where = place if self.cell is None else f"{place}, cell {self.cell!r}"
        return f"{where}: {self.message}"


# A finding with a function that fixes it in place, or None if the author has to fix it.
Difference = tuple[Finding, Callable[[], None] | None]
