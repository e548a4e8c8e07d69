"""Finds the student of a submitted file or folder, from the name that a system gave it.

    Moodle            Jane Doe_1234567_assignsubmission_file_/...     or ..._file_answer.zip, without folders
    Canvas            doejane_LATE_1234567_7654321_answer-1.zip       LATE and -1 (a later attempt) only where it is so
    GitHub Classroom  02-nodes-jane-doe/                              a clone for each student, see `clones`
    nbgrader          jane/ASSIGNMENT/                                the folder of a student, with timestamp.txt
    anything else     jane.zip, jane/                                 what the roster calls the student

The sources: Moodle, mod/assign/locallib.php (`download_submissions`); Canvas, "How do I download all student
submissions"; GitHub Classroom, `gh classroom clone student-repos`; nbgrader, the folder "submitted". In a download of
Gradescope, `submission_metadata.yml` names the students of each folder, and the time of submission. Ruby writes it: its
keys are symbols, such as `:submitters:`, which YAML reads as text with a colon.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from autograder.exceptions import UsageError
from autograder.grade.batch import student_of
from autograder.submission.intake.ignored import is_ignored

METADATA = "submission_metadata.yml"  # of Gradescope

MOODLE = re.compile(r"(?P<name>.+?)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<file>.*))?", re.DOTALL)
CANVAS = re.compile(r"(?P<name>[^_/]+)(?P<late>_LATE)?_(?P<id>\d+)_(?P<file_id>\d+)_(?P<file>.+)", re.DOTALL)

# What Canvas makes of the name of a file that was handed in once more.
VERSION = re.compile(r"(?P<stem>.+)-(?P<version>\d{1,3})(?P<ending>(?:\.[^.]+)?)", re.DOTALL)

IdentityKeys = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class DownloadedItem:
    """A file or folder of a download.

    Attributes:
        path: where it lies.
        name: what its student called it; empty if that is the name of the path.
        doubt: why nobody can say whose it is, if that is so.
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
    name: str = ""
    doubt: str = ""

    @property
    def own_name(self) -> str:
        """What its student called it."""
        return self.name or self.path.name


def read_name(path: Path) -> DownloadedItem:
    """Return what the name of a file or folder says."""
    if found := MOODLE.fullmatch(path.name):
        keys: IdentityKeys = (("identifier", found["id"]), ("name", found["name"]))
        return DownloadedItem(path, keys, is_submission=found["kind"] == "file", name=found["file"] or "")
    if found := CANVAS.fullmatch(path.name):
        late = bool(found["late"])
        return DownloadedItem(path, (("id", found["id"]),), (late,), late, name=found["file"])
    stem = student_of(path)
    kinds = ("login", "number", "sis id", "email", "identifier", "id", "github", "name")
    return DownloadedItem(path, tuple((kind, stem) for kind in kinds))


def resubmitted(items: Sequence[DownloadedItem]) -> list[DownloadedItem]:
    """Return the files of Canvas that a later attempt replaces: `answer.zip` if there is `answer-1.zip`, too.

    The numbers of files say nothing: each file of an attempt has one of its own.
    """
    versions: dict[str, dict[int, DownloadedItem]] = {}
    for item in items:
        if not CANVAS.fullmatch(item.path.name):
            continue
        found = VERSION.fullmatch(item.own_name)
        if found is None:
            versions.setdefault(item.own_name, {})[0] = item
        else:
            versions.setdefault(found["stem"] + found["ending"], {})[int(found["version"])] = item
    return [
        item
        for there in versions.values()
        if 0 in there
        for version, item in sorted(there.items())
        if version < max(there)
    ]


def read_metadata(folder: Path) -> tuple[list[DownloadedItem], list[tuple[str, str]]]:
    """Return what a download of Gradescope holds, an item for each member of a group, and what its list lacks.

    Raises UsageError if its list of submissions cannot be read.
    """
    path = folder / METADATA
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        items = [item for name, entry in data.items() for item in _downloaded_items(folder / name, entry)]
    except (OSError, ValueError, yaml.YAMLError, AttributeError, TypeError, KeyError) as error:
        raise UsageError(f"{path}: cannot be read as Gradescope's list of submissions: {error}") from None
    listed = {item.path.name for item in items}
    beside = [child.name for child in sorted(folder.iterdir()) if not is_ignored(child.name)]
    unlisted = [(name, f"{METADATA} does not list it") for name in beside if name not in {*listed, METADATA}]
    gone = [(name, f"{METADATA} lists it, and it is not there") for name in sorted(listed.difference(beside))]
    return [item for item in items if item.path.exists()], unlisted + gone


def _downloaded_items(folder: Path, entry: dict[str, Any]) -> Iterator[DownloadedItem]:
    kinds = {":sid": "number", ":email": "email", ":name": "name"}
    for person in entry[":submitters"]:
        keys: IdentityKeys = tuple((kind, str(person[key])) for key, kind in kinds.items() if person.get(key))
        yield DownloadedItem(folder, keys, (str(entry.get(":created_at", "")),))
