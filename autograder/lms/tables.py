"""Reads tables that an instructor writes: UTF-8 CSV files with headings, including `student`."""

from __future__ import annotations

import csv
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.lms.roster import Roster, normalized

STUDENT = "student"

FindStudent = Callable[[str], "str | None"]
"""Returns a student's name in results, or None if the student is unknown."""


@dataclass(frozen=True)
class Row:
    """A row of a table: its student, its cells by lower-case headings, and its file and line for messages."""

    student: str
    cells: Mapping[str, str]
    location: str

    def error(self, problem: str) -> UsageError:
        """Return an error about this row."""
        return UsageError(f"{self.location}: {problem}")


def student_finder(known: Collection[str], roster: Roster | None) -> FindStudent:
    """Return a function that finds students by the names of their results, and by any column of the roster."""

    def find(name: str) -> str | None:
        if name in known:
            return name
        student = roster.named(name) if roster is not None else None
        return student.id if student is not None else None

    return find


def read_rows(
    path: Path, required: Collection[str], find_student: FindStudent, *, one_of: Collection[str] = ()
) -> list[Row]:
    """Read the rows of a table. Empty rows and unknown columns are ignored.

    Raises UsageError, with the file and line, if the file cannot be read, lacks the column `student`, a column in
    `required` or all columns in `one_of`, or has a row with an unknown or repeated student or a wrong number of cells.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            lines = [(cells, reader.line_num) for cells in reader if any(cell.strip() for cell in cells)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UsageError(f"{path}: cannot be read as CSV in UTF-8: {error}") from None
    if not lines:
        raise UsageError(f"{path}: the table is empty; its columns are {', '.join((STUDENT, *required))}")
    (heading_row, number), *student_lines = lines
    headings = [normalized(cell) for cell in heading_row]
    for name in (STUDENT, *required):
        if headings.count(name) != 1:
            problem = "is missing" if name not in headings else "occurs twice"
            line = "; ".join(heading_row)
            raise UsageError(
                f"{path}, line {number}: the column {name!r} {problem}; commas separate columns, not {line!r}"
            )
    if one_of and not set(one_of) & set(headings):
        raise UsageError(f"{path}, line {number}: it needs one of the columns {', '.join(one_of)}")
    rows = [_row(headings, cells, f"{path}, line {number}", find_student) for cells, number in student_lines]
    by_student: dict[str, Row] = {}
    for row in rows:
        if row.student in by_student:
            raise row.error(f"{row.student} is also in {by_student[row.student].location}: remove one of the two rows")
        by_student[row.student] = row
    return rows


def _row(headings: list[str], line: list[str], location: str, find_student: FindStudent) -> Row:
    if len(line) != len(headings):
        raise UsageError(f"{location}: {len(line)} cells, but {len(headings)} headings")
    cells = {heading: cell.strip() for heading, cell in zip(headings, line, strict=True)}
    student = find_student(cells[STUDENT])
    if student is None:
        raise UsageError(
            f"{location}: {cells[STUDENT]!r} matches no student or several; give the name of a result's folder"
        )
    return Row(student, cells, location)
