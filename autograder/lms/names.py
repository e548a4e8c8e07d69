"""Reads whose a handed-in file or folder is, from the name that a system gave it.

    Moodle            Jane Doe_1234567_assignsubmission_file_/...     or ..._file_answer.zip, without folders
    Canvas            doejane_LATE_1234567_7654321_answer-1.zip       LATE and -1 (a later attempt) only where it is so
    GitHub Classroom  02-nodes-jane-doe/                              a clone a student, named after the account
    nbgrader          jane/02_nodes/                                  the folder of a student, with timestamp.txt
    anything else     jane.zip, jane/                                 what the roster calls the student

The sources: Moodle, mod/assign/locallib.php (`download_submissions`); Canvas, "How do I download all student
submissions"; GitHub Classroom, `gh classroom clone student-repos`; nbgrader, the folder "submitted". A download of
Gradescope says whose its folders are in `submission_metadata.yml`, which `gradescope.py` reads.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

MOODLE = re.compile(r"(?P<name>.+)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<file>.*))?", re.DOTALL)
CANVAS = re.compile(r"(?P<name>[^_/]+)(?P<late>_LATE)?_(?P<id>\d+)_(?P<file_id>\d+)_(?P<file>.+)", re.DOTALL)

Keys = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class HandedIn:
    """A file or folder of a download.

    Attributes:
        path: where it lies.
        keys: what it says about the student, for `Roster.find`.
        order: of two by one student, the one with the larger order is the newer one.
        late: whether the system says that it came late.
        answer: whether it is an answer; a text that was typed into Moodle is none.
    """

    path: Path
    keys: Keys
    order: tuple[str | int, ...] = ()
    late: bool = False
    answer: bool = True


def read_name(path: Path) -> HandedIn:
    """Return what the name of a file or folder says."""
    if found := MOODLE.fullmatch(path.name):
        keys: Keys = (("identifier", found["id"]), ("name", found["name"]))
        return HandedIn(path, keys, answer=found["kind"] == "file")
    if found := CANVAS.fullmatch(path.name):
        return HandedIn(path, (("id", found["id"]),), (int(found["file_id"]),), bool(found["late"]))
    stem = path.stem if path.is_file() else path.name
    kinds = ("login", "number", "sis id", "email", "identifier", "id", "github", "name")
    return HandedIn(path, tuple((kind, stem) for kind in kinds) + _accounts(stem))


def _accounts(name: str) -> Keys:
    """Return the accounts that a clone's name may end in: each part after a hyphen, the longest first."""
    parts = name.split("-")
    return tuple(("github", "-".join(parts[start:])) for start in range(1, len(parts)))
