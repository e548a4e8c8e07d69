"""Fills marks into the table that Moodle or Canvas exported, so that the system imports it again.

Moodle: the grading worksheet of the assignment (docs.moodle.org, "Using Assignment"). The column `Grade` is
filled in, and all else stays.

Canvas: the export of the gradebook ("How do I import grades in the Gradebook?"). The columns that name students and the
assignment's column are kept. A column that is new makes a new assignment in Canvas.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.lms.roster import Roster, normalized
from autograder.result.model import Result, Status

Rows = list[list[str]]
CANVAS_NAMES = ("student", "id", "sis user id", "sis login id", "integration id", "section")
CANVAS_POINTS = "points possible"


def write_marks(
    results: Sequence[Result],
    system: str,
    roster: Roster,
    out: Path,
    *,
    late: Collection[str] = (),
    late_penalty: float = 0.0,
) -> list[str]:
    """Write the table of a system with the marks of one assignment.

    A submission that was not graded, or that nobody handed in, leaves its cell as it is. Marks are scaled to the most
    that the table says. Students who were `late` lose `late_penalty` percent of theirs. `system` is a key
    of `SYSTEMS`. Raises UsageError if the table lacks a column, or the results are of several assignments.

    Returns:
        The students who have a result and are not in the table.
    """
    marks = {result.student: result for result in results if result.status is Status.GRADED}
    assignments = {result.assignment for result in results}
    if len(assignments) != 1:
        raise UsageError(
            f"a table takes the marks of one assignment, and these are of {', '.join(sorted(assignments))}"
        )

    def share(result: Result) -> float:
        return result.percent / 100 * (1 - late_penalty / 100 * (result.student in late))

    rows = SYSTEMS[system](roster, marks, share, assignments.pop())
    out.parent.mkdir(parents=True, exist_ok=True)
    with out.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(rows)
    known = {student.id for student in roster.students}
    return sorted(result.student for result in results if result.student not in known)


def _moodle(roster: Roster, results: dict[str, Result], share: Callable[[Result], float], assignment: str) -> Rows:
    # The last one is not read here. Moodle refuses a worksheet without it.
    columns = _columns(roster, ("identifier", "grade", "maximum grade", "last modified (grade)"))
    grade, most = columns["grade"], columns["maximum grade"]
    rows = [list(row) for row in roster.rows]
    for student in roster.students:
        if (result := results.get(student.id)) is not None:
            row = rows[student.row]
            row[grade] = _points(share(result) * _number(row[most], roster))
    return [list(roster.headings), *rows]


def _canvas(roster: Roster, results: dict[str, Result], share: Callable[[Result], float], assignment: str) -> Rows:
    columns = _columns(roster, ("student", "id"))
    points = next((row for row in roster.rows if normalized(row[0]) == CANVAS_POINTS), None)
    wanted = normalized(assignment.replace("_", " "))
    fitting = [name for name in columns if wanted in name.replace("_", " ")]
    if len(fitting) > 1:
        raise UsageError(f"{roster.path}: {len(fitting)} columns are called after {assignment}: rename all but one")
    if fitting and points is None:
        raise UsageError(f"{roster.path}: the row `Points Possible` is missing; export the gradebook from Canvas again")
    column = columns[fitting[0]] if fitting else None
    kept = [place for name, place in columns.items() if name in CANVAS_NAMES]
    heading = assignment if column is None else roster.headings[column]
    most = next((r.max_score for r in results.values()), 0.0)
    if column is not None and points is not None:
        most = _number(points[column], roster)
    marks = {s.row: _points(share(results[s.id]) * most) for s in roster.students if s.id in results}
    rows = [[*(roster.headings[place] for place in kept), heading]]
    for place, row in enumerate(roster.rows):
        cell = row[column] if column is not None else _points(most) if row is points else ""
        rows.append([*(row[k] for k in kept), marks.get(place, cell)])
    return rows


SYSTEMS = {"canvas": _canvas, "moodle": _moodle}


def _columns(roster: Roster, needed: tuple[str, ...]) -> dict[str, int]:
    columns = {normalized(heading): place for place, heading in enumerate(roster.headings)}
    missing = [name for name in needed if name not in columns]
    if missing:
        raise UsageError(
            f"{roster.path}: the column {missing[0]!r} is missing; give the table that the system exported"
        )
    width = len(roster.headings)
    short = [number for number, row in enumerate(roster.rows, start=2) if len(row) < width]
    if short:
        raise UsageError(f"{roster.path}: row {short[0]} has fewer columns than the headings")
    return columns


def _number(cell: str, roster: Roster) -> float:
    try:
        return float(cell.strip())
    except ValueError:
        raise UsageError(f"{roster.path}: {cell!r} is no number of points") from None


def _points(value: float) -> str:
    return f"{value:.2f}"
