"""Fills marks into a table that Moodle or Canvas exported, so that the system can import it.

Moodle: the grading worksheet of the assignment (docs.moodle.org, "Using Assignment"). The column `Grade` is filled in,
and everything else is preserved.

Canvas: the exported gradebook ("How do I import grades in the Gradebook?"). Only the columns that identify students and
the assignment's column are kept. A new column creates a new assignment in Canvas.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.lms.roster import Roster, normalized
from autograder.result.model import Result, Status

Rows = list[list[str]]
CANVAS_NAMES = ("student", "id", "sis user id", "sis login id", "integration id", "section")
CANVAS_POINTS = "points possible"


@dataclass(frozen=True)
class MarkTable:
    """The table that a system exported, with the marks of one assignment filled in.

    Attributes:
        rows: all of its rows, the headings first.
        marks: the old and the new cell of each student with a mark.
        unknown: the students who have a result but are not in the table.
    """

    rows: Rows
    marks: Mapping[str, tuple[str, str]]
    unknown: tuple[str, ...]

    def write(self, out: Path) -> None:
        """Write the table as CSV."""
        out.parent.mkdir(parents=True, exist_ok=True)
        with out.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file).writerows(self.rows)


def mark_table(
    results: Sequence[Result], system: str, roster: Roster, kept_shares: Mapping[str, float | None] = {}
) -> MarkTable:
    """Return the table that a system exported, with the marks of one assignment filled in.

    If a submission is missing or was not graded, its cell is unchanged. Marks are scaled to the maximum in the table.

    Args:
        results: the results of one assignment.
        system: a key of `SYSTEMS`.
        roster: the table that the system exported.
        kept_shares: the share of the marks, 0 to 1, that students with late submissions keep; None for no mark.

    Raises:
        UsageError: the table lacks a column, or the results belong to several assignments.
    """
    assignment = one_assignment(results)
    graded_results = {result.student: result for result in results if result.status is Status.GRADED}
    shares = {
        name: result.percent / 100 * share
        for name, result in graded_results.items()
        if (share := kept_shares.get(name, 1.0)) is not None
    }
    known_students = {student.id for student in roster.students}
    unknown = tuple(sorted(result.student for result in results if result.student not in known_students))
    max_points = next((result.max_score for result in graded_results.values()), 0.0)
    rows, marks = SYSTEMS[system](roster, shares, max_points, assignment)
    return MarkTable(rows, marks, unknown)


def one_assignment(results: Sequence[Result]) -> str:
    """Return the assignment to which all results belong. Raises UsageError if they belong to several."""
    assignments = {result.assignment for result in results}
    if len(assignments) != 1:
        raise UsageError(
            f"a table contains the marks of one assignment, but these belong to {', '.join(sorted(assignments))}"
        )
    return assignments.pop()


RowsAndMarks = tuple[Rows, dict[str, tuple[str, str]]]


def _moodle(roster: Roster, shares: Mapping[str, float], max_points: float, assignment: str) -> RowsAndMarks:
    # The last column is not used here, but Moodle rejects a worksheet without it.
    columns = _columns(roster, ("identifier", "grade", "maximum grade", "last modified (grade)"))
    grade, maximum = columns["grade"], columns["maximum grade"]
    rows, marks = [list(row) for row in roster.rows], {}
    for student in roster.students:
        if student.id in shares:
            row = rows[student.row]
            marks[student.id] = row[grade], _points(shares[student.id] * _number(row[maximum], roster))
            row[grade] = marks[student.id][1]
    return [list(roster.headings), *rows], marks


def _canvas(roster: Roster, shares: Mapping[str, float], max_points: float, assignment: str) -> RowsAndMarks:
    columns = _columns(roster, ("student", "id"))
    points = next((row for row in roster.rows if normalized(row[0]) == CANVAS_POINTS), None)
    title = normalized(assignment.replace("_", " "))
    matches = [name for name in columns if title in name.replace("_", " ")]
    if len(matches) > 1:
        raise UsageError(f"{roster.path}: {len(matches)} columns are named after {assignment}: rename all but one")
    if matches and points is None:
        raise UsageError(f"{roster.path}: the row `Points Possible` is missing; export the gradebook from Canvas again")
    column = columns[matches[0]] if matches else None
    name_columns = [index for name, index in columns.items() if name in CANVAS_NAMES]
    heading = assignment if column is None else roster.headings[column]
    if column is not None and points is not None:
        max_points = _number(points[column], roster)
    cells = [row[column] if column is not None else _points(max_points) if row is points else "" for row in roster.rows]
    marks = {}
    for student in roster.students:
        if student.id in shares:
            marks[student.id] = cells[student.row], _points(shares[student.id] * max_points)
            cells[student.row] = marks[student.id][1]
    rows = [[*(row[index] for index in name_columns), cell] for row, cell in zip(roster.rows, cells, strict=True)]
    return [[*(roster.headings[index] for index in name_columns), heading], *rows], marks


SYSTEMS = {"canvas": _canvas, "moodle": _moodle}


def _columns(roster: Roster, required: tuple[str, ...]) -> dict[str, int]:
    columns = {normalized(heading): index for index, heading in enumerate(roster.headings)}
    missing = [name for name in required if name not in columns]
    if missing:
        raise UsageError(f"{roster.path}: the column {missing[0]!r} is missing; use the table that the system exported")
    width = len(roster.headings)
    short_rows = [number for number, row in enumerate(roster.rows, start=2) if len(row) < width]
    if short_rows:
        raise UsageError(f"{roster.path}: row {short_rows[0]} has fewer columns than the headings")
    return columns


def _number(cell: str, roster: Roster) -> float:
    try:
        return float(cell.strip())
    except ValueError:
        raise UsageError(f"{roster.path}: {cell!r} is not a number of points") from None


def _points(value: float) -> str:
    return f"{value:.2f}"
