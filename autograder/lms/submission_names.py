"""Identifies the student of a submitted file or folder from the name that a system gave it.

    Moodle            Jane Doe_1234567_assignsubmission_file_/...     or ..._file_answer.zip, without folders
    Canvas            doejane_LATE_1234567_7654321_answer-1.zip       LATE and -1 (a later attempt) are optional
    Blackboard        02 Nodes_jdoe3_attempt_2026-04-30-21-02-38_answer.zip        and a receipt ending in 38.txt
    Brightspace       397063-2557369 - Jane Doe - Sep 24, 2026 926 PM/             or ... 926 PM - answer.zip
    Sakai             Doe, Jane(jdoe3)/Submission attachment(s)/answer.zip         or, without folders, _ for each /
    GitHub Classroom  02-nodes-jane-doe/                              a clone for each student, see `clones`
    nbgrader          jane/ASSIGNMENT/                                a student's folder, with timestamp.txt
    anything else     jane.zip, jane/                                 the student's name on the roster

Sources: Moodle, mod/assign/locallib.php (`download_submissions`); Canvas, "How do I download all student submissions";
Sakai, AssignmentServiceImpl.java (`zipSubmissions`); GitHub Classroom, `gh classroom clone student-repos`; nbgrader,
the folder "submitted". The name formats of Blackboard and Brightspace come from programs that parse them:
bb-file-cleanup, BBGradebookOrganiser and gradex-cli; kodiak, GradeFast and a `rename_and_move.sh`. In a Gradescope
download, `submission_metadata.yml` lists the students and the submission time of each folder. It is written by Ruby, so
its keys are symbols such as `:submitters:`, which YAML reads as text with colons.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import yaml

from autograder.exceptions import UsageError
from autograder.grade.batch import student_of
from autograder.lms.roster import ANY_KIND
from autograder.submission.intake.ignored import is_ignored

METADATA = "submission_metadata.yml"  # Gradescope's list of submissions

# Files that a system adds to a download for the instructor.
ADDED_FILES = {
    "brightspace": frozenset(("index.html",)),
    "sakai": frozenset(("grades.csv", "grades.xls", "grades.xlsx")),
}

# This follows the student's name in Moodle. It may also occur in a student's name or a file name.
MOODLE = re.compile(r"_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?=_|\Z)")
CANVAS = re.compile(r"(?P<name>[^_/]+)(?P<late>_LATE)?_(?P<id>\d+)_(?P<file_id>\d+)_(?P<file>.+)", re.DOTALL)
# The name of a receipt has no `file`.
BLACKBOARD = re.compile(r"(?P<head>.+?)_attempt_(?P<time>\d{4}(?:-\d\d){5})(?:_(?P<file>.+)|\.txt)", re.DOTALL)
BRIGHTSPACE = re.compile(r"\d+-\d+ - ")
DATE = re.compile(
    r" - (?P<month>[A-Z][a-z]{2}) (?P<day>\d\d?), (?P<year>\d{4}) "
    r"(?P<hour>\d\d?)(?P<minute>\d\d)(?: (?P<half>[AP]M))?(?= - |\Z)"
)
MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
ATTACHMENTS, FEEDBACK = "Submission attachment(s)", "Feedback Attachment(s)"  # folders of Sakai
MAX_LINE = 1000  # characters read from a line
TIME, TEXT = "timestamp.txt", "_submissionText.html"  # files of Sakai

# Canvas's name for a file that was submitted again.
VERSION = re.compile(r"(?P<stem>.+)-(?P<version>\d{1,3})(?P<ending>(?:\.[^.]+)?)", re.DOTALL)

IdentityKeys = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class DownloadedItem:
    """A file or folder of a download.

    Attributes:
        path: its path.
        name: the name that the student gave it; empty if it is the name of the path.
        ambiguity: the reason why it is unclear whose it is, or an empty string.
        keys: identities of the student, for `Roster.find`.
        order: a key that sorts the items of a student; newer items have larger keys.
        late: whether the system marks it as late.
        is_submission: whether it is a submitted file, not a text that was typed into the system.
        is_receipt: whether it is a file that the system writes for each attempt, even without a submitted file.
        system: the system, if the name identifies it.
        time: the submission time in ISO 8601, if the system states it; only Gradescope states the time zone.
    """

    path: Path
    keys: IdentityKeys
    order: tuple[str, ...] = ()
    late: bool = False
    is_submission: bool = True
    name: str = ""
    ambiguity: str = ""
    is_receipt: bool = False
    system: str = ""
    time: str = ""

    @property
    def original_name(self) -> str:
        """The name that the student gave it."""
        return self.name or self.path.name

    @property
    def listed_name(self) -> str:
        """The name that the system gave it."""
        return (self.name if self.system == "sakai" and self.path.is_dir() else "") or self.path.name


def read_names(folder: Path) -> list[DownloadedItem]:
    """Parse the names in a folder, with an item for each member of a group and none for files that a system added."""
    children = [child for child in sorted(folder.iterdir()) if not is_ignored(child.name)]
    items = _without_ambiguous_groups([item for child in children for item in _read_name(child)])
    added_names = frozenset[str]().union(*(ADDED_FILES.get(item.system, ()) for item in items))
    return [item for item in items if item.path.name not in added_names]


def _read_name(path: Path) -> list[DownloadedItem]:
    """Parse the name of a file or folder. Return no items for a student's folder without a submission."""
    if splits := _splits(path, MOODLE):
        return [_read_moodle(path, splits)]
    if match := BLACKBOARD.fullmatch(path.name):
        return [_read_blackboard(path, match)]
    prefix = BRIGHTSPACE.match(path.name)
    if prefix and (splits := _splits(path, DATE, prefix.end())) and all(split["month"] in MONTHS for split in splits):
        return [_read_brightspace(path, prefix.end(), splits)]
    if match := CANVAS.fullmatch(path.name):
        late = bool(match["late"])
        order = ("late",) if late else ("",)
        return [DownloadedItem(path, (("id", match["id"]),), order, late, name=match["file"], system="canvas")]
    if members := _members(path):
        return [replace(item, keys=keys) for item in _read_sakai(path) for keys in members]
    stem = student_of(path)
    return [DownloadedItem(path, tuple((kind, stem) for kind in ANY_KIND))]


def _splits(path: Path, pattern: re.Pattern[str], start: int = 0) -> list[re.Match[str]]:
    """Return the possible boundaries between a student's name and a file's name; one if there is no file name.

    Students choose both names, so several boundaries are possible. The roster decides which one is right.
    """
    splits = [split for split in pattern.finditer(path.name, start) if split.start() > start]
    return splits[-1:] if splits and path.name[splits[-1].end() :] in ("", "_") else splits


def _read_moodle(path: Path, splits: list[re.Match[str]]) -> DownloadedItem:
    """Parse a name from Moodle. If it is ambiguous, number and name must belong to the same student."""
    first, names = splits[0], [path.name[: split.start()] for split in splits]
    keys: IdentityKeys = (("identifier", first["id"]), ("name", names[0]))
    if len(splits) > 1:
        keys = tuple(
            ("identifier and name", f"{split['id']} {name}") for split, name in zip(splits, names, strict=True)
        )
    return DownloadedItem(path, keys, is_submission=first["kind"] == "file", name=path.name[first.end() + 1 :])


def _read_brightspace(path: Path, start: int, splits: list[re.Match[str]]) -> DownloadedItem:
    """Parse a name from Brightspace. If it is ambiguous, the roster must contain exactly one of the names."""
    names = [path.name[start : split.start()] for split in splits]
    keys = _brightspace_keys(names[0]) if len(names) == 1 else tuple(("name", name) for name in names)
    file = path.name[splits[0].end() :].removeprefix(" - ")
    time = _time(splits[0])
    return DownloadedItem(path, keys, (time,), name=file, system="brightspace", time=time)


def _read_blackboard(path: Path, match: re.Match[str]) -> DownloadedItem:
    """Parse a name from Blackboard. The receipt identifies the student, because course and student may contain `_`."""
    login, file = _login(path.with_name(f"{match['head']}_attempt_{match['time']}.txt")), match["file"] or ""
    has_receipt = bool(login) and match["head"].endswith(f"_{login}")
    return DownloadedItem(
        path,
        tuple((kind, login) for kind in ("login", "number", "email", "id")) if has_receipt else (),
        (match["time"],),
        is_submission=bool(file),
        name=file,
        ambiguity="" if has_receipt else "unclear: its Blackboard receipt is missing, or names another student",
        is_receipt=not file,
        system="blackboard",
        time="{}-{}-{} {}:{}:{}".format(*match["time"].split("-")),
    )


def _login(receipt: Path) -> str:
    """Return the login in the first line of a Blackboard receipt, `Name: Jane Doe (jdoe3)`, or an empty string."""
    try:
        with receipt.open(encoding="utf-8", errors="replace") as file:
            name, _, login = file.readline(MAX_LINE).strip().rpartition("(")
    except OSError:
        return ""
    return login.removesuffix(")") if name.startswith("Name:") else ""


def _time(match: re.Match[str]) -> str:
    """Return the time in a Brightspace name, in a form that sorts chronologically."""
    hour, month = int(match["hour"]), MONTHS.index(match["month"]) + 1
    if match["half"]:
        hour = hour % 12 + 12 * (match["half"] == "PM")
    return f"{match['year']}-{month:02}-{int(match['day']):02} {hour:02}:{match['minute']}"


def _brightspace_keys(name: str) -> IdentityKeys:
    """Return the keys in a Brightspace name: a student's name, which may follow the name of a group."""
    return ("name", name), ("number", name), ("login", name), ("name", name.rpartition(" - ")[2])


def _members(path: Path) -> list[IdentityKeys]:
    """Return the keys of each group member in a Sakai name: `Doe, Jane(jdoe3); Roe, Bob(broe)`."""
    member_names = path.name if path.is_dir() else path.name.partition(f"_{ATTACHMENTS}_")[0].removesuffix(f"_{TEXT}")
    # If the folder's name occurs twice, one occurrence is part of a student's name or a file's name.
    if not path.is_dir() and path.name.count(f"_{ATTACHMENTS}_") > 1:
        return []
    members: list[IdentityKeys] = []
    for entry in member_names.split("; "):
        name, bracket, account = entry.rpartition("(")
        if not (bracket and account.endswith(")") and "," in name):
            return []
        kinds = ("id", "login", "number", "email")
        members.append((*((kind, account[:-1]) for kind in kinds), ("name", name)))
    return members if member_names != path.name or path.is_dir() else []


def _without_ambiguous_groups(items: list[DownloadedItem]) -> list[DownloadedItem]:
    """Remove the keys from items of a Sakai group if one of its members has an individual submission.

    A Sakai group looks like a student whose name contains another student's name.
    """
    paths = [item.path for item in items]
    groups = [item for item in items if item.system == "sakai" and paths.count(item.path) > 1]
    individuals = {item.keys[:1] for item in items if item not in groups}
    ambiguous = {item.path for item in groups if item.keys[:1] in individuals}
    ambiguity = "unclear: a member of this group also has an individual submission"
    return [replace(item, keys=(), ambiguity=ambiguity) if item.path in ambiguous else item for item in items]


def _read_sakai(path: Path) -> list[DownloadedItem]:
    """Return the submission in a student's Sakai folder or in a file without folders, as an item without keys."""
    if not path.is_dir():
        file = path.name.partition(f"_{ATTACHMENTS}_")[2]
        return [DownloadedItem(path, (), is_submission=bool(file), name=file, is_receipt=not file, system="sakai")]
    # The name of this folder depends on the language of Sakai.
    folders = [child for child in sorted(path.iterdir()) if child.is_dir() and child.name != FEEDBACK]
    filled_folders = [child for child in folders if any(child.iterdir())]
    if len(filled_folders) == 1:
        return [DownloadedItem(filled_folders[0], (), name=path.name, system="sakai")]
    if not filled_folders and not (path / TIME).is_file():
        return []
    return [DownloadedItem(path, (), is_submission=False, system="sakai")]


def resubmitted(items: Sequence[DownloadedItem]) -> list[DownloadedItem]:
    """Return the Canvas files that a later attempt replaces: `answer.zip` if there is also `answer-1.zip`.

    The numeric ids of files do not help, because every file of an attempt has a different one.
    """
    versions: dict[str, dict[int, DownloadedItem]] = {}
    for item in items:
        if item.system != "canvas":
            continue
        match = VERSION.fullmatch(item.original_name)
        if match is None:
            versions.setdefault(item.original_name, {})[0] = item
        else:
            versions.setdefault(match["stem"] + match["ending"], {})[int(match["version"])] = item
    return [
        item
        for by_version in versions.values()
        if 0 in by_version
        for version, item in sorted(by_version.items())
        if version < max(by_version)
    ]


def read_metadata(folder: Path) -> tuple[list[DownloadedItem], list[tuple[str, str]]]:
    """Return the items of a Gradescope download, one for each group member, and pairs (name, reason) for the rest.

    Raises UsageError if the list of submissions cannot be read.
    """
    path = folder / METADATA
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
        items = [item for name, entry in data.items() for item in _downloaded_items(folder / name, entry)]
    except (OSError, ValueError, yaml.YAMLError, AttributeError, TypeError, KeyError) as error:
        raise UsageError(f"{path}: cannot be read as Gradescope's list of submissions: {error}") from None
    listed = {item.path.name for item in items}
    existing = [child.name for child in sorted(folder.iterdir()) if not is_ignored(child.name)]
    unlisted = [(name, f"{METADATA} does not list it") for name in existing if name not in {*listed, METADATA}]
    missing = [(name, f"{METADATA} lists it, but it is missing") for name in sorted(listed.difference(existing))]
    return [item for item in items if item.path.exists()], unlisted + missing


def _downloaded_items(folder: Path, entry: dict[str, Any]) -> Iterator[DownloadedItem]:
    kinds = {":sid": "number", ":email": "email", ":name": "name"}
    for student in entry[":submitters"]:
        keys: IdentityKeys = tuple((kind, str(student[key])) for key, kind in kinds.items() if student.get(key))
        time = str(entry.get(":created_at", ""))
        yield DownloadedItem(folder, keys, (time,), time=time)
