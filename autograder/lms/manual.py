"""Adds manual points to results, from a CSV file with a column for each manually graded cell.

    student,q2-answer,q2-answer comment
    ada,5.5,A missing reason.

The maximum points of a cell come from the course's own notebook. A result with manual points has an additional check
for each cell, so that every export and every page includes them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from autograder.author.course.cells import is_manually_graded
from autograder.author.course.sync import Chapter
from autograder.course_paths import chapter
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.lms.tables import FindStudent, Row, read_rows
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome, Visibility

COMMENT = " comment"  # a cell's name with this ending is the heading of an optional column


@dataclass(frozen=True)
class ManualMark:
    """The manual points for a cell, or None if there are none yet, and a comment for the student."""

    points: float | None
    comment: str = ""


ManualMarks = Mapping[str, Mapping[str, ManualMark]]
"""The marks of each student, by the names of cells."""


def manual_cells(assignment: str) -> dict[str, float]:
    """Return the manually graded cells of an assignment's notebook, with their maximum points."""
    cells = Chapter(chapter(assignment)).read().cells
    graded = (cell.metadata.nbgrader for cell in cells if is_manually_graded(cell))
    return {str(graded_cell["grade_id"]): float(graded_cell["points"]) for graded_cell in graded}


def read_manual(path: Path, cells: Mapping[str, float], find_student: FindStudent) -> ManualMarks:
    """Read the manual points for the cells of an assignment.

    Raises UsageError, with the line, if a column is missing, a student is unknown or repeated, or points are not a
    number from 0 to the cell's maximum.
    """
    return {
        row.student: {
            name: ManualMark(_points(row, name, max_points), row.cells.get(name + COMMENT, ""))
            for name, max_points in cells.items()
        }
        for row in read_rows(path, tuple(cells), find_student)
    }


def add_manual(
    results: Sequence[Result], marks: ManualMarks, cells: Mapping[str, float]
) -> tuple[list[Result], list[tuple[str, str]]]:
    """Add manual points to graded results. Also return pairs (student, sentence) for incomplete points.

    The result of such a student is unclear: it has no mark, and its sentence says which points are missing. Raises
    UsageError if a student has points above 0 but no result.
    """
    without_result = sorted(
        student
        for student in marks.keys() - {result.student for result in results}
        if any(mark.points for mark in marks[student].values())
    )
    if without_result:
        raise UsageError(f"points for {', '.join(without_result)} without a result: grade a submission first")
    new_results = [_with_marks(result, marks.get(result.student, {}), cells) for result in results]
    pairs = zip(results, new_results, strict=True)
    return new_results, [(new.student, new.diagnosis.sentence) for old, new in pairs if old.status is not new.status]


def _with_marks(result: Result, marks: Mapping[str, ManualMark], cells: Mapping[str, float]) -> Result:
    if result.status is not Status.GRADED:
        return result
    missing_names = [name for name in cells if name not in marks or marks[name].points is None]
    if missing_names:
        sentence = f"Not marked yet: {', '.join(missing_names)}."
        return replace(result, status=Status.UNCLEAR, diagnosis=Diagnosis(Kind.UNCLEAR, sentence))
    checks = [_check_result(name, max_points, marks[name]) for name, max_points in cells.items()]
    max_points = math.fsum((result.max_score, *cells.values()))
    return replace(result, checks=(*result.checks, *checks), max_score=max_points)


def _check_result(name: str, max_points: float, mark: ManualMark) -> CheckResult:
    points = mark.points or 0.0
    return CheckResult(
        id=name,
        title=f"{name} was marked by hand." + (f" {mark.comment}" if mark.comment else ""),
        group=name,
        points=points,
        max_points=max_points,
        outcome=Outcome.PASSED if points == max_points else Outcome.FAILED,
        message="",
        hints=(),
        doc=None,
        visibility=Visibility.HIDDEN,
        seconds=0.0,
    )


def _points(row: Row, name: str, max_points: float) -> float | None:
    text = row.cells[name]
    if not text:
        return None
    try:
        points = float(text)
    except ValueError:
        raise row.error(f"{text!r} is not a number of points for {name}; write 4.5, not 4,5") from None
    if not 0 <= points <= max_points:
        raise row.error(f"{text} points for {name}: the points must be from 0 to {max_points:g}")
    return points
