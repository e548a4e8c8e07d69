"""Reads the instructor's settings of the service from a YAML file. Errors name the line.

    instructors: [grace]              may see the class and all feedback
    timezone: Europe/Berlin           for the times below and for tries per day; UTC by default
    exchange: /srv/ros2/exchange/ros2-python/inbound   submissions in this folder are also graded
    assignments:
      10_mapping:
        due: 2026-10-12 23:59         the last time for handing in; never by default
        tries_a_day: 5                for each student; 5 by default
        shown: visible                before it is due: everything, visible, points or nothing
        counts: best                  the mark that counts for a student: best or last; last by default
        extensions: {ada: 2026-10-19 23:59}

Only `assignments` is required.
"""

from __future__ import annotations

import zoneinfo
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime, timezone, tzinfo
from enum import Enum
from pathlib import Path

import yaml

from autograder.exceptions import UsageError
from autograder.suite import suites
from sim.exceptions import WorldError
from sim.fields import Reader, Units, error_at

TRIES_A_DAY = 5
MAX_TRIES = 1000
MAX_INSTRUCTORS = 100_000
MAX_BYTES = 1024 * 1024


class ShownParts(str, Enum):
    """The parts of a grading that a student sees before the assignment is due. After that, everything is shown."""

    EVERYTHING = "everything"  # the feedback page
    VISIBLE = "visible"  # the checks that students can run themselves
    POINTS = "points"  # the points of the whole answer
    NOTHING = "nothing"  # only that the answer was received and graded


@dataclass(frozen=True)
class AssignmentSettings:
    """The settings of one assignment. Times have a time zone; None means never."""

    due: datetime | None = None
    tries_a_day: int = TRIES_A_DAY
    shown: ShownParts = ShownParts.EVERYTHING
    best_counts: bool = False
    extensions: Mapping[str, datetime] = field(default_factory=dict)

    def due_of(self, student: str) -> datetime | None:
        """Return the last time at which a student can hand in, or None if there is no limit."""
        return self.extensions.get(student, self.due)

    def is_open(self, student: str, now: datetime) -> bool:
        """Return whether a student can hand in."""
        due = self.due_of(student)
        return due is None or now <= due

    def shown_to(self, student: str, now: datetime) -> ShownParts:
        """Return the parts of a grading that the student sees."""
        return self.shown if self.is_open(student, now) else ShownParts.EVERYTHING


@dataclass(frozen=True)
class Settings:
    """All settings of the service."""

    assignments: Mapping[str, AssignmentSettings]
    instructors: frozenset[str] = frozenset()
    zone: tzinfo = timezone.utc
    exchange: Path | None = None

    def tries_left(self, assignment: str, earlier: Iterable[datetime], now: datetime) -> int:
        """Return how often a student who handed in at the times `earlier` can still hand in today."""
        today = now.astimezone(self.zone).date()
        used_tries = sum(time.astimezone(self.zone).date() == today for time in earlier)
        return max(0, self.assignments[assignment].tries_a_day - used_tries)


def read_settings(path: Path) -> Settings:
    """Read a settings file. Raises UsageError, with the file and the line, if it is invalid."""
    try:
        top = _compose(path)
        reader = Reader(path, Units())
        fields = reader.fields(top, "the file", ("assignments",), ("instructors", "timezone", "exchange"))
        zone = _zone(reader, fields.get("timezone"))
        items = reader.items(fields.get("instructors"), "instructors", MAX_INSTRUCTORS)
        instructors = frozenset(_text(reader, node, "an instructor") for node in items)
        names = suites.graded_assignments()
        entries = reader.fields(fields["assignments"], "assignments", (), names)
        assignments = {name: _assignment(reader, name, node, zone) for name, node in entries.items()}
        if not assignments:
            raise error_at(path, fields["assignments"], "no assignment is configured", f"Name one, such as {names[0]}")
        return Settings(assignments, instructors, zone, _exchange(reader, fields.get("exchange")))
    except WorldError as error:  # from `Reader`, which also reads the simulator's files
        raise UsageError(str(error)) from None


def _compose(path: Path) -> yaml.MappingNode:
    try:
        data = path.read_bytes()
        if len(data) > MAX_BYTES:
            raise UsageError(f"{path}: larger than {MAX_BYTES // 2**20} MiB, which is too large for settings")
        node = yaml.compose(data.decode("utf-8-sig"), Loader=yaml.SafeLoader)
    except OSError as error:
        raise UsageError(f"{path}: the settings cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: the settings are not UTF-8 text: save them as UTF-8") from None
    except yaml.MarkedYAMLError as error:
        line = f":{error.problem_mark.line + 1}" if error.problem_mark else ""
        raise UsageError(f"{path}{line}: this is not YAML: {error.problem}. Indent with spaces.") from None
    except (yaml.YAMLError, RecursionError) as error:
        raise UsageError(f"{path}: this is not YAML: {error}") from None
    if not isinstance(node, yaml.MappingNode):
        raise UsageError(f"{path}:1: the settings are a mapping: begin with a line `assignments:`")
    return node


def _assignment(reader: Reader, name: str, node: yaml.Node, zone: tzinfo) -> AssignmentSettings:
    if isinstance(node, yaml.ScalarNode) and not node.value:  # the assignment has no settings
        return AssignmentSettings()
    known_fields = ("due", "tries_a_day", "shown", "counts", "extensions")
    fields = reader.fields(node, name, (), known_fields)
    due = _time(reader, fields["due"], "due", zone) if "due" in fields else None
    extensions = _extensions(reader, fields.get("extensions"), zone)
    if extensions and due is None:
        raise error_at(reader.path, fields["extensions"], f"{name} has extensions and is never due", "Add `due`")
    shown = reader.choice(
        fields.get("shown"), "shown", [choice.value for choice in ShownParts], ShownParts.EVERYTHING.value
    )
    counts = reader.choice(fields.get("counts"), "counts", ("best", "last"), "last")
    return AssignmentSettings(
        due, _tries(reader, fields.get("tries_a_day")), ShownParts(shown), counts == "best", extensions
    )


def _extensions(reader: Reader, node: yaml.Node | None, zone: tzinfo) -> dict[str, datetime]:
    if node is None:
        return {}
    if not isinstance(node, yaml.MappingNode):
        raise error_at(reader.path, node, "extensions are not a mapping", "Give {ada: 2026-10-19 23:59}")
    names = [_text(reader, key, "a student") for key, _ in node.value]
    fields = reader.fields(node, "extensions", (), names)
    return {name: _time(reader, value, f"the extension of {name}", zone) for name, value in fields.items()}


def _tries(reader: Reader, node: yaml.Node | None) -> int:
    if node is None:
        return TRIES_A_DAY
    number = reader.number(node, "tries_a_day")
    if number != int(number) or not 1 <= number <= MAX_TRIES:
        raise error_at(reader.path, node, f"tries_a_day is {number:g}", f"Give a whole number from 1 to {MAX_TRIES}")
    return int(number)


def _time(reader: Reader, node: yaml.Node, label: str, zone: tzinfo) -> datetime:
    text = _text(reader, node, label)
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        raise error_at(reader.path, node, f"{label} is {text!r}", "Give a time such as 2026-10-12 23:59") from None
    if len(text) <= len("2026-10-12"):  # Python reads a date as its start, but people mean its end
        raise error_at(reader.path, node, f"{label} has no time of day", f"Write {text} 23:59")
    return time if time.tzinfo is not None else time.replace(tzinfo=zone)


def _exchange(reader: Reader, node: yaml.Node | None) -> Path | None:
    if node is None:
        return None
    path = Path(_text(reader, node, "exchange"))
    if not path.is_absolute() or path.name != "inbound":
        example = "/srv/ros2/exchange/ros2-python/inbound"
        remedy = f"Give the course's folder in it, such as {example}"
        raise error_at(reader.path, node, f"exchange is {str(path)!r}", remedy)
    return path


def _zone(reader: Reader, node: yaml.Node | None) -> tzinfo:
    name = "UTC" if node is None else _text(reader, node, "timezone")
    if node is None or name == "UTC":
        return timezone.utc
    try:
        return zoneinfo.ZoneInfo(name)
    except (OSError, ValueError, KeyError):  # a folder, a path outside the database, or an unknown name
        raise error_at(reader.path, node, f"unknown time zone {name!r}", "Give one such as Europe/Berlin") from None


def _text(reader: Reader, node: yaml.Node, label: str) -> str:
    text = reader.text(node, label).strip()
    if not text:
        raise error_at(reader.path, node, f"{label} is blank", "Write it, or leave the line out")
    return text
