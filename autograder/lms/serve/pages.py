"""The content of the service's pages. Their templates escape all text.

The pages have the hub's own origin and may contain a student's text. Therefore, only the player's script is allowed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from autograder.lms.serve import visible
from autograder.lms.serve.hand_in import HandIn, counted_hand_in
from autograder.lms.serve.settings import AssignmentSettings, Settings, ShownParts
from autograder.report.feedback import PAGE
from autograder.report.feedback.pages import environment
from autograder.result.model import Status

TIME = "%Y-%m-%d %H:%M"


@dataclass(frozen=True)
class Row:
    """A hand-in on a page: its time, its state, its points (empty if they are not shown), and whether it counts."""

    hand_in: HandIn
    at: str
    state: str
    points: str = ""
    counts: bool = False


@dataclass(frozen=True)
class Section:
    """An assignment on a student's page."""

    name: str
    due: str  # empty if it is never due
    is_open: bool
    tries_left: int
    tries_a_day: int
    rows: tuple[Row, ...]


def sections(
    settings: Settings, all_hand_ins: Sequence[HandIn], positions: Mapping[int, str], student: str, now: datetime
) -> list[Section]:
    """Return a student's assignments, with the hand-ins of each.

    `positions` maps the number of each ungraded hand-in to a text that says where it is in the queue.
    """
    student_sections = []
    for name, rules in settings.assignments.items():
        hand_ins = [hand_in for hand_in in all_hand_ins if hand_in.assignment == name]
        due = rules.due_of(student)
        student_sections.append(
            Section(
                name,
                "" if due is None else due.astimezone(settings.zone).strftime(TIME),
                rules.is_open(student, now),
                settings.tries_left(name, [hand_in.at for hand_in in hand_ins if hand_in.costs_a_try], now),
                rules.tries_a_day,
                rows(settings, rules, hand_ins, positions, rules.shown_to(student, now)),
            )
        )
    return student_sections


def rows(
    settings: Settings,
    rules: AssignmentSettings,
    hand_ins: Sequence[HandIn],
    positions: Mapping[int, str],
    shown_parts: ShownParts,
) -> tuple[Row, ...]:
    """Return a student's hand-ins of an assignment, the newest first, with points if they are shown."""
    sees_points = shown_parts in (ShownParts.EVERYTHING, ShownParts.POINTS)
    counted = counted_hand_in(hand_ins, best=rules.best_counts) if sees_points else None
    table_rows = []
    for hand_in in reversed(hand_ins):
        at = hand_in.at.astimezone(settings.zone).strftime(TIME)
        if hand_in.mark is None:
            table_rows.append(Row(hand_in, at, positions[hand_in.number]))
        else:
            points = points_text(hand_in) if sees_points else ""
            table_rows.append(Row(hand_in, at, hand_in.mark.status.words, points, hand_in == counted))
    return tuple(table_rows)


def points_text(hand_in: HandIn) -> str:
    """Return a mark in readable form, or an empty string without a mark."""
    if hand_in.mark is None or hand_in.mark.status is not Status.GRADED:
        return ""
    return f"{hand_in.mark.points:g} of {hand_in.mark.max_points:g}"


def home(student: str, student_sections: Sequence[Section], *, teaches: bool, prefix: str, zone: str) -> str:
    """Return a student's page. For instructors, it has links to the pages of the class."""
    return _render(
        "serve_home.html.j2", student=student, sections=student_sections, teaches=teaches, prefix=prefix, zone=zone
    )


def class_page(
    settings: Settings, assignment: str, hand_ins: Sequence[HandIn], waiting: int, prefix: str, form: str
) -> str:
    """Return the page of a class for its instructors: a row for each student, with the mark that counts.

    `form` is the hidden field with the XSRF token.
    """
    best = settings.assignments[assignment].best_counts
    student_rows = []
    for student in sorted({hand_in.student for hand_in in hand_ins}):
        student_hand_ins = [hand_in for hand_in in hand_ins if hand_in.student == student]
        counted = counted_hand_in(student_hand_ins, best=best) or student_hand_ins[-1]
        state = "waits" if counted.mark is None else counted.mark.status.words
        at = counted.at.astimezone(settings.zone).strftime(TIME)
        student_rows.append((student, len(student_hand_ins), Row(counted, at, state, points_text(counted))))
    graded = sum(hand_in.mark is not None for hand_in in hand_ins)
    values = {"assignment": assignment, "rows": student_rows, "waiting": waiting, "prefix": prefix}
    return _render("serve_class.html.j2", **values, graded=graded, form=form)


def feedback(hand_in: HandIn, folder: Path, shown_parts: ShownParts) -> bytes:
    """Return the page of a graded hand-in, with the parts that are shown."""
    if shown_parts is ShownParts.EVERYTHING:
        return (folder / PAGE).read_bytes()
    report = visible.read(folder) if shown_parts is ShownParts.VISIBLE else None
    points = points_text(hand_in) if shown_parts is ShownParts.POINTS else ""
    return _render(
        "serve_graded.html.j2", hand_in=hand_in, shown=shown_parts.value, points=points, report=report
    ).encode()


def state(hand_in: HandIn, position: str) -> str:
    """Return the page of an ungraded hand-in, with its position in the queue."""
    return _render("serve_graded.html.j2", hand_in=hand_in, shown="waiting", points=position, report=None)


def error(status: int, sentence: str) -> str:
    """Return an error page."""
    return _render("serve_error.html.j2", status=status, sentence=sentence)


def _render(template: str, **values: object) -> str:
    return environment().get_template(template).render(**values)
