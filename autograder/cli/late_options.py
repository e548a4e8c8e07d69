"""The options of `autograder export` for late submissions, and their effect on a class."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from datetime import timedelta
from pathlib import Path
from typing import Any, TypeVar

import click

from autograder.exceptions import UsageError
from autograder.lms.lateness import Delivery, Lateness, LatePolicy, parse_time, read_extensions, zone_of
from autograder.lms.tables import FindStudent
from autograder.result.class_folder import COLLECTION_REPORT

Command = TypeVar("Command", bound=Callable[..., Any])

_PERCENT = click.FloatRange(0, 100)
_OPTIONS = (
    click.option(
        "--late-penalty",
        type=_PERCENT,
        default=0.0,
        metavar="PERCENT",
        help="Subtract PERCENT of its marks from a late submission, however late. For canvas, csv and moodle.",
    ),
    click.option(
        "--late-per-day",
        type=_PERCENT,
        default=0.0,
        metavar="PERCENT",
        help="Subtract PERCENT of its marks from a late submission for each day that has begun.",
    ),
    click.option(
        "--late-floor",
        type=_PERCENT,
        default=0.0,
        metavar="PERCENT",
        help="A late submission keeps at least PERCENT of its marks.",
    ),
    click.option(
        "--grace",
        type=click.FloatRange(0, 24 * 365),
        default=0.0,
        metavar="HOURS",
        help="Do not penalize a submission that is at most HOURS late.",
    ),
    click.option(
        "--due",
        metavar="TIME",
        help="When the assignment was due, such as 2026-05-04T18:00+02:00. A time without a zone is this machine's.",
    ),
    click.option(
        "--extensions",
        type=click.Path(path_type=Path, dir_okay=False, exists=True),
        help="A CSV file with the deadlines of individual students: the columns student, and days or until.",
    ),
)


def late_options(command: Command) -> Command:
    """Add the options to a command, which receives them as keyword arguments."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def read_policy(find_student: FindStudent, options: dict[str, Any]) -> LatePolicy:
    """Return the policy that the options describe. Raises UsageError if they conflict, or a file or time is invalid."""
    if options["late_penalty"] and options["late_per_day"]:
        raise UsageError("--late-penalty is for all late submissions, --late-per-day for each day: give one of the two")
    text, extensions = options["due"], options["extensions"]
    try:
        due, zone = (parse_time(text, None), zone_of(text)) if text else (None, None)
    except UsageError as error:
        raise UsageError(f"--due: {error}") from None
    return LatePolicy(
        flat=options["late_penalty"],
        per_day=options["late_per_day"],
        floor=options["late_floor"],
        grace=timedelta(hours=options["grace"]),
        due=due,
        zone=zone,
        extensions=read_extensions(extensions, find_student, zone) if extensions is not None else {},
    )


def class_lateness(policy: LatePolicy, results: Path, students: Iterable[str]) -> dict[str, Lateness]:
    """Return how late each student's submission was, according to what `autograder grade --roster` recorded."""
    file = results / COLLECTION_REPORT
    report = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
    late, late_by, times = set(report.get("late", ())), report.get("late_by", {}), report.get("times", {})
    by_student = {}
    for student in students:
        delay = timedelta(seconds=late_by[student]) if student in late_by else None
        try:
            time = parse_time(times[student], policy.zone) if times.get(student) else None
        except UsageError as error:
            raise UsageError(f"{file}: {error}") from None
        by_student[student] = policy.lateness_of(student, Delivery(student in late, delay, time))
    return by_student
