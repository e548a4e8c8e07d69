"""Reads a list of students from another system: Moodle's grading worksheet, Canvas's gradebook, or a CSV roster.

It recognizes the columns of Moodle's offline grading worksheet, Canvas's gradebook export, GitHub Classroom's
`classroom_roster.csv`, Gradescope's roster, nbgrader's `db student import`, Blackboard's grade centre, Brightspace's
grades (numbers and logins start with `#`) and Sakai's `grades.csv` (the headings are in the third line).
"""

from __future__ import annotations

import csv
import re
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from autograder.exceptions import UsageError

# The kind of identity in a column, by its heading in lower case.
COLUMNS = {
    "identifier": "identifier",
    "id": "id",
    "sis user id": "sis id",
    "sis login id": "login",
    "username": "login",
    "github_username": "github",
    "id number": "number",
    "student id": "number",
    "sid": "number",
    "orgdefinedid": "number",
    "org defined id": "number",
    "display id": "number",
    "email address": "email",
    "email": "email",
    "full name": "name",
    "student": "name",
    "name": "name",
    "first name": "first",
    "last name": "last",
    "status": "status",
}
# The first of these kinds that a student has becomes the name of the result folder.
FOLDER_NAME_KINDS = ("login", "number", "email", "identifier", "id", "name")
# The kinds of identity that a text may be, the most certain first.
ANY_KIND = ("login", "number", "sis id", "email", "identifier", "id", "github", "name")
LATE = re.compile(r"\d \w+ late\b")  # matches this status in Moodle: "Submitted for grading - 1 day 2 hours late"
PART = re.compile(r"(\d{1,9}) (year|week|day|hour|min|sec)s?\b")  # a part of a duration from Moodle's `format_time`
# The length of each unit in seconds.
SECONDS = {"year": 31_536_000, "week": 604_800, "day": 86_400, "hour": 3_600, "min": 60, "sec": 1}
MAX_TITLE_LINES = 3  # first lines that may contain the headings, because a title may precede them
PARTICIPANT = "participant "  # Moodle's prefix before a student's number, which is also in file names
NOT_STUDENTS = ("points possible", "student, test")  # special rows of Canvas


@dataclass(frozen=True)
class Student:
    """A student of the roster.

    `id` is the name of the result folder. `keys` are identities as pairs (kind, text), both normalized; kinds are
    values of `COLUMNS`. `row` counts from 0, without the headings. `late` is whether Moodle's table marks the
    submission as late, and `late_by` the delay in seconds, rounded down by Moodle.
    """

    id: str
    keys: frozenset[tuple[str, str]]
    row: int
    late: bool = False
    late_by: int | None = None


@dataclass(frozen=True)
class Roster:
    """A table of students: its file, the students in order, the headings, and all rows unchanged."""

    path: Path
    students: tuple[Student, ...]
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def find(self, keys: tuple[tuple[str, str], ...]) -> Student | None:
        """Return the student identified by the first kind of key that matches exactly one student, or None."""
        for kind in dict.fromkeys(kind for kind, _ in keys):
            keys_of_kind = {(kind, normalized(value)) for other, value in keys if other == kind}
            matching_students = [student for student in self.students if keys_of_kind & student.keys]
            if len(matching_students) == 1:
                return matching_students[0]
        return None

    def named(self, text: str) -> Student | None:
        """Return the only student that a text identifies by any column of the roster, or None."""
        return self.find(tuple((kind, text) for kind in ANY_KIND))


def normalized(text: str) -> str:
    """Return the text in the Unicode form NFKC, case-folded, with single spaces."""
    return " ".join(unicodedata.normalize("NFKC", text).casefold().split())


def read_roster(path: Path) -> Roster:
    """Read a table of students from a UTF-8 CSV file, with headings in one of its first lines.

    Raises UsageError if it cannot be read, has no column that identifies students, or contains a student twice.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = [tuple(row) for row in csv.reader(file) if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UsageError(f"{path}: cannot be read as UTF-8 CSV: {error}") from None
    if not lines:
        raise UsageError(f"{path}: the table is empty")
    is_heading = [bool(set(_kinds(line)) & set(FOLDER_NAME_KINDS)) for line in lines[:MAX_TITLE_LINES]]
    headings, *rows = lines[is_heading.index(True) if any(is_heading) else 0 :]
    kinds = _kinds(headings)
    if not set(kinds) & set(FOLDER_NAME_KINDS):
        known_headings = ", ".join(sorted(COLUMNS))
        raise UsageError(f"{path}: no column identifies the students; the known headings are {known_headings}")
    students = [student for index, row in enumerate(rows) if (student := _student(kinds, row, index)) is not None]
    names = [student.id for student in students]
    duplicates = sorted({name for name in names if names.count(name) > 1})
    if duplicates:
        raise UsageError(f"{path}: two students are called {', '.join(duplicates)}; give each a unique name or number")
    return Roster(path, tuple(students), headings, tuple(rows))


def _kinds(headings: tuple[str, ...]) -> list[str]:
    return [COLUMNS.get(normalized(heading), "") for heading in headings]


def _student(kinds: list[str], row: tuple[str, ...], index: int) -> Student | None:
    cells = {kind: cell.strip() for kind, cell in zip(kinds, row, strict=False) if kind and cell.strip()}
    for kind in cells.keys() & {"number", "login"}:
        cells[kind] = cells[kind].removeprefix("#")
    if "name" not in cells and {"first", "last"} <= cells.keys():
        cells["name"] = f"{cells['first']} {cells['last']}"
    if not cells or normalized(row[0]) in NOT_STUDENTS:
        return None
    keys = {(kind, normalized(value)) for kind, value in cells.items()}
    participant = normalized(cells.get("identifier", ""))
    if participant.startswith(PARTICIPANT):
        number = participant.removeprefix(PARTICIPANT)
        keys |= {("identifier", number), ("identifier and name", normalized(f"{number} {cells.get('name', '')}"))}
    name = (
        next(cells[kind] for kind in FOLDER_NAME_KINDS if kind in cells) if set(cells) & set(FOLDER_NAME_KINDS) else ""
    )
    status = next((part for part in cells.get("status", "").split(" - ") if LATE.search(part)), "")
    late_by = sum(int(count) * SECONDS[unit] for count, unit in PART.findall(status)) if status else None
    folder = name.replace("/", "-").replace("\0", "")
    return Student(folder, frozenset(keys), index, bool(status), late_by or None) if name else None
