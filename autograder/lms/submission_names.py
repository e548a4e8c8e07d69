"""Finds the student of a submitted file or folder, from the name that a system gave it.

    Moodle            Jane Doe_1234567_assignsubmission_file_/...     or ..._file_answer.zip, without folders
    Canvas            doejane_LATE_1234567_7654321_answer-1.zip       LATE and -1 (a later attempt) only where it is so
    GitHub Classroom  02-nodes-jane-doe/                              a clone for each student, named after the account
    nbgrader          jane/ASSIGNMENT/                                the folder of a student, with timestamp.txt
    anything else     jane.zip, jane/                                 what the roster calls the student

The sources: Moodle, mod/assign/locallib.php (`download_submissions`); Canvas, "How do I download all student
submissions"; GitHub Classroom, `gh classroom clone student-repos`; nbgrader, the folder "submitted". In a download of
Gradescope, `submission_metadata.yml` names the students of each folder, and the time of submission. Ruby writes it: its
keys are symbols, such as `:submitters:`, which YAML reads as text with a colon.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from autograder.exceptions import UsageError

METADATA = "submission_metadata.yml"  # of Gradescope

MOODLE = re.compile(r"(?P<name>.+)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<file>.*))?", re.DOTALL)
CANVAS = re.compile(r"(?P<name>[^_/]+)(?P<late>_LATE)?_(?P<id>\d+)_(?P<file_id>\d+)_(?P<file>.+)", re.DOTALL)

IdentityKeys = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class DownloadedItem:
    """A file or folder of a download.

    Attributes:
        path: where it lies.
        keys: what the download says about its student, for `Roster.find`.
        order: of two items of one student, the one with the larger order is the newer one.
        late: whether the system says that it came late.
        is_submission: whether it is a submitted file; a text that was typed into Moodle is not.
    """

    path: Path
    keys: IdentityKeys
    order: tuple[str | int, ...] = ()
    late: bool = False
    is_submission: bool = True


def read_name(path: Path) -> DownloadedItem:
    """Return what the name of a file or folder says."""
    if found := MOODLE.fullmatch(path.name):
        keys: IdentityKeys = (("identifier", found["id"]), ("name", found["name"]))
        return DownloadedItem(path, keys, is_submission=found["kind"] == "file")
    if found := CANVAS.fullmatch(path.name):
        return DownloadedItem(path, (("id", found["id"]),), (int(found["file_id"]),), bool(found["late"]))
    stem = path.stem if path.is_file() else path.name
    kinds = ("login", "number", "sis id", "email", "identifier", "id", "github", "name")
    return DownloadedItem(path, tuple((kind, stem) for kind in kinds) + _accounts(stem))


def _accounts(name: str) -> IdentityKeys:
    """Return the accounts that a clone's name may end in: each part after a hyphen, the longest first."""
    parts = name.split("-")
    return tuple(("github", "-".join(parts[start:])) for start in range(1, len(parts)))


def read_metadata(folder: Path) -> list[DownloadedItem]:
    """Return what a download of Gradescope holds. Raises UsageError if its list of submissions cannot be read."""
    path = folder / METADATA
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        return [_downloaded_item(folder / name, entry) for name, entry in data.items() if (folder / name).is_dir()]
    except (OSError, ValueError, yaml.YAMLError, AttributeError, TypeError, KeyError) as error:
        raise UsageError(f"{path}: cannot be read as Gradescope's list of submissions: {error}") from None


def _downloaded_item(folder: Path, entry: dict[str, Any]) -> DownloadedItem:
    kinds = {":sid": "number", ":email": "email", ":name": "name"}
    people = entry[":submitters"]
    keys: IdentityKeys = tuple(
        (kind, str(person[key])) for person in people for key, kind in kinds.items() if person.get(key)
    )
    return DownloadedItem(folder, keys, (str(entry.get(":created_at", "")),))
