"""The table of students, as a system exports it: Moodle's grading worksheet, Canvas's gradebook, rosters in CSV.

The columns are those of Moodle's assign module (offline grading worksheet), Canvas's gradebook export, GitHub
Classroom's `classroom_roster.csv`, Gradescope's roster and nbgrader's `db student import`; those of Blackboard's grade
centre, Brightspace's grades (numbers and logins begin with `#`) and Sakai's `grades.csv` (its headings come third).
"""

from __future__ import annotations

import csv
import re
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from autograder.exceptions import UsageError

# What a column says of a student, by its heading in lower case.
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
# The first of these that a student has names the folder of the result.
NAMES_A_STUDENT = ("login", "number", "email", "identifier", "id", "name")
# What a text may be that names a student, the most certain first.
ANY_KIND = ("login", "number", "sis id", "email", "identifier", "id", "github", "name")
LATE = re.compile(r"\d \w+ late\b")  # in Moodle's status: "Submitted for grading - 1 day 2 hours late"
PART = re.compile(r"(\d{1,9}) (year|week|day|hour|min|sec)s?\b")  # of a duration, as Moodle's `format_time` writes it
SECONDS = {"year": 31_536_000, "week": 604_800, "day": 86_400, "hour": 3_600, "min": 60, "sec": 1}
TITLES = 3  # lines in which the headings may stand; the first ones may be a title
PARTICIPANT = "participant "  # what Moodle writes before the number that it also puts into file names
NOT_STUDENTS = ("points possible", "student, test")  # rows of Canvas


@dataclass(frozen=True)
class Student:
    """A student: the name in results, what is known of them as pairs of a kind and a text, and the number of their row.

    Kinds are values of `COLUMNS`. Kind and text are normalized. Rows are counted from 0, without the headings. `late`
    says whether Moodle's table calls the submission late, and `late_by` by how many seconds, rounded down by Moodle.
    """

    id: str
    keys: frozenset[tuple[str, str]]
    row: int
    late: bool = False
    late_by: int | None = None


@dataclass(frozen=True)
class Roster:
    """A table of students: the file, the students in its order, its headings, and all its rows as they are."""

    path: Path
    students: tuple[Student, ...]
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def find(self, keys: tuple[tuple[str, str], ...]) -> Student | None:
        """Return the student whom keys of one kind mean: the first kind whose keys fit exactly one student."""
        for kind in dict.fromkeys(kind for kind, _ in keys):
            wanted = {(kind, normalized(value)) for other, value in keys if other == kind}
            fitting = [student for student in self.students if wanted & student.keys]
            if len(fitting) == 1:
                return fitting[0]
        return None

    def named(self, text: str) -> Student | None:
        """Return the one student whom a text names, by whatever the roster says of them."""
        return self.find(tuple((kind, text) for kind in ANY_KIND))


def normalized(text: str) -> str:
    """Return the text in Unicode's form NFKC, in one case, with single spaces."""
    return " ".join(unicodedata.normalize("NFKC", text).casefold().split())


def read_roster(path: Path) -> Roster:
    """Read a table of students: CSV in UTF-8, with headings in its first line.

    Raises UsageError if it cannot be read, has no column that names students, or names one twice.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            lines = [tuple(row) for row in csv.reader(file) if any(cell.strip() for cell in row)]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise UsageError(f"{path}: cannot be read as CSV in UTF-8: {error}") from None
    if not lines:
        raise UsageError(f"{path}: the table is empty")
    first = next((place for place, line in enumerate(lines[:TITLES]) if set(_kinds(line)) & set(NAMES_A_STUDENT)), 0)
    headings, *rows = lines[first:]
    kinds = _kinds(headings)
    if not set(kinds) & set(NAMES_A_STUDENT):
        known = ", ".join(sorted(COLUMNS))
        raise UsageError(f"{path}: no column names the students; the headings that are known are {known}")
    students = [found for place, row in enumerate(rows) if (found := _student(kinds, row, place)) is not None]
    names = [student.id for student in students]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise UsageError(f"{path}: two students are called {', '.join(twice)}; give each a name or number of its own")
    return Roster(path, tuple(students), headings, tuple(rows))


def _kinds(headings: tuple[str, ...]) -> list[str]:
    return [COLUMNS.get(normalized(heading), "") for heading in headings]


def _student(kinds: list[str], row: tuple[str, ...], place: int) -> Student | None:
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
    name = next(cells[kind] for kind in NAMES_A_STUDENT if kind in cells) if set(cells) & set(NAMES_A_STUDENT) else ""
    status = next((part for part in cells.get("status", "").split(" - ") if LATE.search(part)), "")
    late_by = sum(int(count) * SECONDS[unit] for count, unit in PART.findall(status)) if status else None
    folder = name.replace("/", "-").replace("\0", "")
    return Student(folder, frozenset(keys), place, bool(status), late_by or None) if name else None
