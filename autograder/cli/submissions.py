"""Finds the submissions that a command is given: paths, or with --roster one download of a system such as Moodle."""

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

REPORTED = ("late", "late_by", "times", "older", "unmatched", "missing")  # what is written of a download
roster_option = click.option(
    "--roster",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="The table of students as CSV. PATHS is then one download of Moodle, Canvas, Gradescope or GitHub Classroom.",
)


@contextmanager
def find_submissions(
    paths: tuple[Path, ...], assignment: str, roster: Path | None, *, out: Path | None = None, verb: str = "graded"
) -> Iterator[tuple[Mapping[str, Path], bool]]:
    """Yield the submissions by their students, and whether each item that was found belongs to one.

    What belongs to nobody is printed: it is not `verb`. What a download says of late and missing students is printed,
    and written to the folder `out`, if there is one.
    """
    if roster is None:
        discovered = discover(paths, assignment)
        _print_others(discovered.others, verb)
        yield discovered.submissions, not discovered.others
        return
    if len(paths) != 1:
        raise UsageError("--roster goes with one download: give one zip or folder")
    with unpacked(paths[0]) as folder, TemporaryDirectory(prefix="attempts-") as scratch:
        found = collect(folder, read_roster(roster), assignment, Path(scratch))
        _print_others(found.unmatched, verb)
        for title, names in (("Nothing handed in", found.missing), ("Late", found.late), ("Older ones", found.older)):
            if names:
                echo(f"{title}: {', '.join(map(on_line, names))}")
        if out is not None:
            lists = {name: getattr(found, name) for name in REPORTED}
            write_json(out / COLLECTION_REPORT, lists)
        yield found.submissions, not found.unmatched


def _print_others(others: Sequence[tuple[str, str]], verb: str) -> None:
    for name, why in others:
        echo(f"Not {verb}: {on_line(name)}: {on_line(why)}.", err=True)
