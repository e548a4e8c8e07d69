"""`autograder similar`: finds the submissions of a class that are similar to each other."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from autograder import course_paths
from autograder.author.course.release import write_release
from autograder.cli.options import json_option
from autograder.cli.submissions import find_submissions, roster_option
from autograder.cli.terminal import echo, on_line
from autograder.exceptions import AutograderError, StudentError, UsageError
from autograder.grade.isolated_reader import code, read_code
from autograder.result.model import write_json
from autograder.run.sandbox import Isolation
from autograder.submission.intake import read_submission

if TYPE_CHECKING:
    from autograder.lms.similar import Group


@click.command()
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--assignment", required=True, metavar="ID", help="The assignment of the submissions.")
@click.option("--out", required=True, type=click.Path(path_type=Path, file_okay=False), help="The folder for the page.")
@roster_option
@click.option(
    "--least",
    "min_percent",
    type=click.FloatRange(0, 100),
    default=50.0,
    show_default=True,
    metavar="PERCENT",
    help="Group two students if at least PERCENT of one's own code is also in the other's.",
)
@json_option
def similar(
    paths: tuple[Path, ...], assignment: str, out: Path, roster: Path | None, min_percent: float, json_file: Path | None
) -> None:
    """List groups of submissions at PATHS with similar passages. Code from the student release is ignored.

    PATHS are the same as for `autograder grade`. A group is a reason to read the submissions, not a verdict. No mark
    changes.

    The exit status is 0 if every submission was compared, 1 if one cannot be read or matches no student in --roster, or
    if there are fewer than two to compare, and 2 for wrong usage.
    """
    try:
        from autograder.lms.similar import compare, write_page
    except ModuleNotFoundError as error:
        if error.name != "copydetect":
            raise
        raise UsageError("this needs copydetect: run `.venv/bin/pip install copydetect`") from None

    def report_partial(student: str, reason: str) -> None:
        echo(f"Compared in part: {on_line(student)}: {reason}", err=True)

    with tempfile.TemporaryDirectory() as scratch:
        write_release(Path(scratch) / "given", (assignment,))
        provided_code = code(
            read_submission(Path(scratch) / "given" / course_paths.course().chapters / assignment, assignment)
        )
    with find_submissions(paths, assignment, roster, verb="compared") as (submissions, all_match):
        codes, all_read = _read_codes(submissions, assignment)
    comparison = compare(codes, provided_code, min_percent / 100, report_partial)
    for student in comparison.without_own_code:
        echo(f"Not compared: {on_line(student)}: it contains no code of its own", err=True)
    compared_count = len(codes) - len(comparison.without_own_code)
    if compared_count < 2:
        hint = "; for a download from an LMS, give its table of students with --roster" if roster is None else ""
        own_code = "1 contains code of its own" if compared_count else "0 contain code of their own"
        raise AutograderError(f"nothing was compared: of {len(submissions)} submissions, {own_code}{hint}")
    for group in comparison.groups:
        echo(_group_sentence(group))
    groups = f"{len(comparison.groups)} {'group' if len(comparison.groups) == 1 else 'groups'}"
    echo(f"{compared_count} compared, {groups} to read (not a verdict): {write_page(comparison, out)}")
    if json_file is not None:
        write_json(json_file, [_as_json(group) for group in comparison.groups])
    sys.exit(0 if all_match and all_read else 1)


def _read_codes(submissions: Mapping[str, Path], assignment: str) -> tuple[dict[str, str], bool]:
    """Return the code of each submission, and whether all can be read. Students with one submission share an entry."""
    students: dict[Path, list[str]] = {}
    for student, path in submissions.items():
        students.setdefault(path, []).append(student)
    codes, all_read = {}, True
    for path, names in students.items():
        try:
            codes[" + ".join(names)] = read_code(path, assignment, Isolation.BUBBLEWRAP)
        except StudentError as error:
            echo(f"Not compared: {on_line(' + '.join(names))}: {on_line(error)}", err=True)
            all_read = False
    return codes, all_read


def _as_json(group: Group) -> dict[str, object]:
    pairs = [{"students": pair.names, "shares": pair.shares} for pair in group.pairs]
    return {"students": group.names, "pairs": pairs}


def _group_sentence(group: Group) -> str:
    *others, last = map(on_line, group.names)
    if len(others) == 1:
        percent = " and ".join(f"{100 * share:.0f} %" for share in group.pairs[0].shares)
    else:
        shares = [100 * max(pair.shares) for pair in group.pairs]
        percent = f"{min(shares):.0f} to {max(shares):.0f} %"
    return f"{', '.join(others)} and {last}: {percent} of their own text in common"
