"""Finds the submissions for a command: paths or, with --roster, one download from a system such as Moodle."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from autograder.cli.terminal import echo, on_line
from autograder.exceptions import UsageError
from autograder.grade.batch import discover
from autograder.lms.collect import collect, unpacked
from autograder.lms.roster import read_roster
from autograder.result.class_folder import COLLECTION_REPORT
from autograder.result.model import write_json

# The attributes of `CollectedSubmissions` that are written to the report of a download.
REPORT_FIELDS = ("late", "late_by", "times", "older", "unmatched", "missing")
roster_option = click.option(
    "--roster",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="A CSV table of the students. PATHS is then one download from Moodle, Canvas, Gradescope or GitHub Classroom.",
)


@contextmanager
def find_submissions(
    paths: tuple[Path, ...], assignment: str, roster: Path | None, *, out: Path | None = None, verb: str = "graded"
) -> Iterator[tuple[Mapping[str, Path], bool]]:
    """Yield the submissions by student, and whether every item matches a student.

    Items that match no student are printed as "Not graded" (or another `verb`). The late and the missing students of a
    download are printed, and written to the folder `out` if it is given.
    """
    if roster is None:
        discovered_submissions = discover(paths, assignment)
        _print_unused(discovered_submissions.other_files, verb)
        yield discovered_submissions.submissions, not discovered_submissions.other_files
        return
    if len(paths) != 1:
        raise UsageError("--roster needs exactly one download: a zip or a folder")
    with unpacked(paths[0]) as folder, TemporaryDirectory(prefix="attempts-") as scratch:
        collected_submissions = collect(folder, read_roster(roster), assignment, Path(scratch))
        _print_unused(collected_submissions.unmatched, verb)
        names_by_label = {
            "Not submitted": collected_submissions.missing,
            "Late": collected_submissions.late,
            "Replaced": collected_submissions.older,
        }
        for label, names in names_by_label.items():
            if names:
                echo(f"{label}: {', '.join(map(on_line, names))}")
        if out is not None:
            report = {name: getattr(collected_submissions, name) for name in REPORT_FIELDS}
            write_json(out / COLLECTION_REPORT, report)
        yield collected_submissions.submissions, not collected_submissions.unmatched


def _print_unused(entries: Sequence[tuple[str, str]], verb: str) -> None:
    for name, reason in entries:
        echo(f"Not {verb}: {on_line(name)}: {on_line(reason)}.", err=True)
