"""`autograder export`: writes stored results in other programs' formats."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import click

from autograder import course_paths
from autograder.cli.late_options import class_lateness, late_options, read_policy
from autograder.cli.options import json_option
from autograder.cli.terminal import echo, on_line
from autograder.cli.text_tables import table
from autograder.exceptions import UsageError
from autograder.lms.collect import unpacked
from autograder.lms.feedback_archive import canvas_paths, moodle_paths, write_archive
from autograder.lms.lateness import Lateness
from autograder.lms.manual import add_manual, manual_cells, read_manual
from autograder.lms.marks import SYSTEMS, mark_table, one_assignment
from autograder.lms.roster import Roster, read_roster
from autograder.lms.tables import FindStudent, student_finder
from autograder.report import export as exporters
from autograder.result.model import Result, Status, write_json

_FOLDERS = " and ".join(name for name, format in exporters.FORMATS.items() if format.FOLDER)
_FEEDBACK = {f"{system}-feedback": system for system in SYSTEMS}  # the formats for feedback, and their systems
_WITH_LATENESS = ("csv", *SYSTEMS)  # the formats that can reduce the marks of late submissions

LeftOut = list[tuple[str, str]]  # pairs (student, reason) of the students who get no mark or feedback


@dataclass(frozen=True)
class Plan:
    """What an export would write: the old and the new cell of each student, and the students who are left out."""

    rows: Sequence[tuple[str, str, str]]
    left_out: LeftOut
    write: Callable[[], object]


@click.command()
@click.argument("results", type=click.Path(path_type=Path))
@click.option(
    "--format",
    "name",
    required=True,
    type=click.Choice(sorted([*exporters.FORMATS, *SYSTEMS, *_FEEDBACK])),
    help="The format to write.",
)
@click.option(
    "--out",
    required=True,
    type=click.Path(path_type=Path),
    help=f"The file to write; for {_FOLDERS}, the folder.",
)
@click.option(
    "--roster",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="For canvas and moodle: the table that the system exported, to fill with the marks.",
)
@click.option(
    "--manual",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="A CSV file with manual points: the column student, and one for each manually graded cell.",
)
@click.option(
    "--download",
    type=click.Path(path_type=Path, exists=True),
    help="For canvas-feedback: the download of the submissions, for the file names that Canvas expects.",
)
@late_options
@click.option("--dry-run", is_flag=True, help="Write nothing: list what would be written for each student.")
@json_option
def export(
    results: Path,
    name: str,
    out: Path,
    roster: Path | None,
    manual: Path | None,
    download: Path | None,
    dry_run: bool,
    json_file: Path | None,
    **late_arguments: Any,
) -> None:
    """Write stored RESULTS (a folder or a JSON file) as marks or feedback for other programs.

    The exit status is 0 if every student in RESULTS is included, 1 if some are left out and listed, and 2 for wrong
    usage.
    """
    stored_results: Sequence[Result] = exporters.load(results)
    student_table = read_roster(roster) if roster is not None else None
    if student_table is None and name in (*SYSTEMS, *_FEEDBACK):
        raise UsageError(f"--format {name} needs --roster: the table that {_FEEDBACK.get(name, name).title()} exported")
    if any(late_arguments.values()) and name not in _WITH_LATENESS:
        raise UsageError(f"marks of late submissions are for --format {', '.join(_WITH_LATENESS)}, not {name}")
    find_student = student_finder({result.student for result in stored_results}, student_table)
    stored_results, left_out = _add_manual_points(stored_results, manual, find_student)
    lateness = class_lateness(
        read_policy(find_student, late_arguments), results, (result.student for result in stored_results)
    )
    if student_table is not None and name in SYSTEMS:
        plan = _plan_marks(stored_results, name, student_table, lateness, out)
    elif student_table is not None and name in _FEEDBACK:
        plan = _plan_feedback(
            [result for result in stored_results if result.student not in dict(left_out)],
            name,
            student_table,
            download,
            out,
        )
    else:
        plan = _plan_results(stored_results, name, lateness if any(late_arguments.values()) else {}, out)
    left_out = list(dict((*plan.left_out, *left_out)).items())
    if dry_run:
        echo(
            table([(*row, dict(left_out).get(row[0], "")) for row in plan.rows], ("student", "now", "new", "left out"))
        )
        echo(f"Nothing was written. Without --dry-run, {len(plan.rows)} results go to {out}.")
    else:
        destination = plan.write()
        echo(f"{len(stored_results)} results: {destination}")
    for student, reason in left_out:
        echo(f"Left out: {on_line(student)}: {on_line(reason)}", err=True)
    if json_file is not None:
        write_json(
            json_file, {"results": len(stored_results), "format": name, "written": "" if dry_run else str(destination)}
        )
    sys.exit(1 if left_out else 0)


def _add_manual_points(
    stored_results: Sequence[Result], manual: Path | None, find_student: FindStudent
) -> tuple[Sequence[Result], LeftOut]:
    """Add manual points to the results. Return the new results, and the students whose points are incomplete."""
    if manual is None:
        for assignment in sorted({result.assignment for result in stored_results} & _assignments()):
            if cells := manual_cells(assignment):
                missing_points = f"{sum(cells.values()):g} manual points ({', '.join(cells)})"
                echo(f"{assignment} has {missing_points}, which are missing here: add them with --manual", err=True)
        return stored_results, []
    assignment = one_assignment(stored_results)
    cells = manual_cells(assignment)
    if not cells:
        raise UsageError(f"{assignment} has no manually graded cells: remove --manual")
    return add_manual(stored_results, read_manual(manual, cells, find_student), cells)


def _assignments() -> set[str]:
    """Return the assignments of the course. They are empty if no course exists, because export does not need one."""
    try:
        return set(course_paths.assignments())
    except UsageError:
        return set()


def _plan_marks(
    stored_results: Sequence[Result], system: str, roster: Roster, lateness: Mapping[str, Lateness], out: Path
) -> Plan:
    """Plan a table of marks for a learning management system."""
    unclear_students = {student: late.unclear for student, late in lateness.items() if late.unclear}
    kept_shares = {student: None if late.unclear else late.kept_share for student, late in lateness.items()}
    mark_cells = mark_table(stored_results, system, roster, kept_shares)
    left_out = [(r.student, r.status.words) for r in stored_results if r.status is not Status.GRADED]
    left_out += [*unclear_students.items(), *((student, f"not in {roster.path}") for student in mark_cells.unknown)]
    rows = [(result.student, *mark_cells.marks.get(result.student, ("", ""))) for result in stored_results]

    def write() -> Path:
        mark_cells.write(out)
        return out

    return Plan(rows, left_out, write)


def _plan_feedback(
    stored_results: Sequence[Result], name: str, roster: Roster, download: Path | None, out: Path
) -> Plan:
    """Plan a zip with the feedback of all students except those whose grading failed."""
    graded_results = [result for result in stored_results if result.status is not Status.NOT_GRADED]
    students = [result.student for result in graded_results]
    if _FEEDBACK[name] == "moodle":
        paths = moodle_paths(roster, students)
    elif download is None:
        raise UsageError(f"--format {name} needs --download: the zip of the submissions, as Canvas made it")
    else:
        with unpacked(download) as folder:
            paths = canvas_paths(folder, roster, one_assignment(stored_results), students)
    left_out = [(r.student, r.status.words) for r in stored_results if r.status is Status.NOT_GRADED]
    rows = [(student, "", paths.by_student.get(student, "")) for student in students]

    def write() -> Path:
        write_archive(graded_results, paths, out)
        return out

    return Plan(rows, [*left_out, *paths.left_out], write)


def _plan_results(stored_results: Sequence[Result], name: str, lateness: Mapping[str, Lateness], out: Path) -> Plan:
    """Plan an export of results. A CSV file gets additional columns for late submissions."""
    extra_cells = {
        result.student: _late_cells(result, lateness[result.student]) for result in stored_results if lateness
    }
    left_out = [(student, late.unclear) for student, late in lateness.items() if late.unclear]
    rows = [
        (r.student, "", str(extra_cells[r.student]["mark"] if extra_cells else _score_text(r))) for r in stored_results
    ]
    options: dict[str, Any] = {"extra_cells": extra_cells} if extra_cells else {}
    return Plan(rows, left_out, partial(exporters.write, stored_results, name, out, **options))


def _late_cells(result: Result, late: Lateness) -> dict[str, str | float]:
    days = "" if late.unclear or late.days is None else late.days
    mark = "" if late.unclear or result.status is not Status.GRADED else round(result.score * late.kept_share, 4)
    return {"late_days": days, "mark": mark}


def _score_text(result: Result) -> str:
    return f"{result.score:g}" if result.status is Status.GRADED else ""
