"""The service's pages, from templates that escape all text. This module chooses what a page shows.

A page is served from the hub's own address, and may contain a student's text: only the player's script may run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from autograder.lms.serve import visible
from autograder.lms.serve.hand_in import HandIn, counting
from autograder.lms.serve.settings import AssignmentSettings, Settings, Shown
from autograder.report.feedback import PAGE
from autograder.report.feedback.pages import environment
from autograder.result.model import Status

TIME = "%Y-%m-%d %H:%M"


@dataclass(frozen=True)
class Row:
    """A hand-in on a page: the mark in words, empty where it is not shown, and whether it is the one that counts."""

    hand_in: HandIn
    at: str
    state: str
    points: str = ""
    counts: bool = False


@dataclass(frozen=True)
class Section:
    """An assignment on a student's page."""

    name: str
    due: str  # empty if it never is
    is_open: bool
    tries_left: int
    tries_a_day: int
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class Place:
    """The position of a hand-in in the queue."""

    is_graded_now: bool
    ahead: int

    @property
    def words(self) -> str:
        """The place as people read it."""
        if self.is_graded_now:
            return "being graded"
        return "next" if self.ahead == 0 else f"waits: {self.ahead} before it"


def sections(
    settings: Settings, own: Sequence[HandIn], places: dict[int, Place], student: str, now: datetime
) -> list[Section]:
    """Return a student's assignments, with the hand-ins of each."""
    listed = []
    for name, each in settings.assignments.items():
        hand_ins = [one for one in own if one.assignment == name]
        due = each.due_of(student)
        listed.append(
            Section(
                name,
                "" if due is None else due.astimezone(settings.zone).strftime(TIME),
                each.is_open(student, now),
                settings.tries_left(name, [one.at for one in hand_ins if one.costs_a_try], now),
                each.tries_a_day,
                rows(settings, each, hand_ins, places, each.shown_to(student, now)),
            )
        )
    return listed


def rows(
    settings: Settings, each: AssignmentSettings, own: Sequence[HandIn], places: dict[int, Place], shown: Shown
) -> tuple[Row, ...]:
    """Return a student's hand-ins of an assignment, the newest first, as far as they are shown."""
    sees_points = shown in (Shown.EVERYTHING, Shown.POINTS)
    counts = counting(own, best=each.best_counts) if sees_points else None
    listed = []
    for one in reversed(own):
        at = one.at.astimezone(settings.zone).strftime(TIME)
        if one.mark is None:
            listed.append(Row(one, at, places[one.number].words if one.number in places else "waits"))
        else:
            points = points_text(one) if sees_points else ""
            listed.append(Row(one, at, one.mark.status.words, points, one == counts))
    return tuple(listed)


def points_text(one: HandIn) -> str:
    """Return a mark in readable form, or an empty string without a mark."""
    if one.mark is None or one.mark.status is not Status.GRADED:
        return ""
    return f"{one.mark.points:g} of {one.mark.max_points:g}"


def home(student: str, listed: Sequence[Section], *, teaches: bool, prefix: str, zone: str) -> str:
    """Return a student's page. Instructors have links to the pages of the class, too."""
    return _render("serve_home.html.j2", student=student, sections=listed, teaches=teaches, prefix=prefix, zone=zone)


def class_page(
    settings: Settings, assignment: str, hand_ins: Sequence[HandIn], waiting: int, prefix: str, form: str
) -> str:
    """Return the page of a class for its instructors: a row for each student, with the mark that counts.

    `form` is the hidden field by which the service knows a form of its own page.
    """
    best = settings.assignments[assignment].best_counts
    listed = []
    for student in sorted({one.student for one in hand_ins}):
        own = [one for one in hand_ins if one.student == student]
        counted = counting(own, best=best) or own[-1]
        state = "waits" if counted.mark is None else counted.mark.status.words
        at = counted.at.astimezone(settings.zone).strftime(TIME)
        listed.append((student, len(own), Row(counted, at, state, points_text(counted))))
    graded = sum(one.mark is not None for one in hand_ins)
    values = {"assignment": assignment, "rows": listed, "waiting": waiting, "prefix": prefix}
    return _render("serve_class.html.j2", **values, graded=graded, form=form)


def feedback(hand_in: HandIn, folder: Path, shown: Shown) -> bytes:
    """Return the page of a graded hand-in, as much of it as is shown."""
    if shown is Shown.EVERYTHING:
        return (folder / PAGE).read_bytes()
    report = visible.read(folder) if shown is Shown.VISIBLE else None
    points = points_text(hand_in) if shown is Shown.POINTS else ""
    return _render("serve_graded.html.j2", hand_in=hand_in, shown=shown.value, points=points, report=report).encode()


def state(hand_in: HandIn, place: str) -> str:
    """Return the page of a hand-in that is not graded yet."""
    return _render("serve_graded.html.j2", hand_in=hand_in, shown="waiting", points=place, report=None)


def error(status: int, sentence: str) -> str:
    """Return the page of an error."""
    return _render("serve_error.html.j2", status=status, sentence=sentence)


def _render(template: str, **values: object) -> str:
    return environment().get_template(template).render(**values)
