"""`autograder compare`: lists the students and checks whose points differ between two gradings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

import click

from autograder.cli.options import json_option
from autograder.cli.terminal import echo, on_line
from autograder.report import export
from autograder.report.export.changes import Change, CheckChange, changes
from autograder.result.model import write_json


@click.command()
@click.argument("old", type=click.Path(path_type=Path))
@click.argument("new", type=click.Path(path_type=Path))
@json_option
def compare(old: Path, new: Path, json_file: Path | None) -> None:
    """List the students whose marks differ between the stored results OLD and NEW, with the checks that differ.

    OLD and NEW are folders that `autograder grade --out` wrote, or JSON files. After changing a suite, grade the class
    into another folder and compare the two.
    """
    student_changes = changes(export.load(old), export.load(new))
    print_changes(student_changes)
    students = f"{len(student_changes)} {'student' if len(student_changes) == 1 else 'students'}"
    echo(f"{students} with a different result" if student_changes else "No result has changed.")
    if json_file is not None:
        write_json(json_file, [asdict(change) for change in student_changes])


def print_changes(student_changes: Iterable[Change]) -> None:
    """Print the students whose results differ, their marks, and the checks that differ."""
    for change in student_changes:
        marks = f"{_number_text(change.before)} -> {_number_text(change.after)}"
        echo(f"{on_line(change.student)} ({on_line(change.assignment)}): {marks}{_submission_note(change)}")
        for check in change.checks:
            echo(f"    {on_line(check.id)}: {_points_text(check)}")


def _submission_note(change: Change) -> str:
    if change.before is None or change.after is None or change.same_submission:
        return ""
    return ", for a different submission"


def _points_text(check: CheckChange) -> str:
    return f"{_number_text(check.before, 'not in the suite')} -> {_number_text(check.after, 'not in the suite')}"


def _number_text(points: float | None, missing: str = "no mark") -> str:
    return missing if points is None else f"{points:g}"
