"""Finds the student of a submitted file or folder, from the name that a system gave it.

    Moodle            Jane Doe_1234567_assignsubmission_file_/...     or ..._file_answer.zip, without folders
    Canvas            doejane_LATE_1234567_7654321_answer-1.zip       LATE and -1 (a later attempt) only where it is so
    Blackboard        02 Nodes_jdoe3_attempt_2026-04-30-21-02-38_answer.zip        and a receipt that ends in 38.txt
    Brightspace       397063-2557369 - Jane Doe - Sep 24, 2026 926 PM/             or ... 926 PM - answer.zip
    Sakai             Doe, Jane(jdoe3)/Submission attachment(s)/answer.zip         or, without folders, _ for each /
    GitHub Classroom  02-nodes-jane-doe/                              a clone for each student, see `clones`
    nbgrader          jane/ASSIGNMENT/                                the folder of a student, with timestamp.txt
    anything else     jane.zip, jane/                                 what the roster calls the student

The sources: Moodle, mod/assign/locallib.php (`download_submissions`); Canvas, "How do I download all student
submissions"; Sakai, AssignmentServiceImpl.java (`zipSubmissions`); GitHub Classroom, `gh classroom clone
student-repos`; nbgrader, the folder "submitted". Names of Blackboard and Brightspace come from programs that read them:
bb-file-cleanup, BBGradebookOrganiser and gradex-cli; kodiak, GradeFast and a `rename_and_move.sh`. In a download of
Gradescope, `submission_metadata.yml` names the students of each folder, and the time of submission. Ruby writes it: its
keys are symbols, such as `:submitters:`, which YAML reads as text with a colon.
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

METADATA = "submission_metadata.yml"  # of Gradescope

# Files that a system adds to a download, for the instructor.
ADDED = {
    "brightspace": frozenset(("index.html",)),
    "sakai": frozenset(("grades.csv", "grades.xls", "grades.xlsx")),
}

# What follows a name in Moodle. A student can put one into their own name, or into that of a file.
MOODLE = re.compile(r"_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?=_|\Z)")
CANVAS = re.compile(r"(?P<name>[^_/]+)(?P<late>_LATE)?_(?P<id>\d+)_(?P<file_id>\d+)_(?P<file>.+)", re.DOTALL)
BLACKBOARD = re.compile(
    r"(?P<head>.+?)_attempt_(?P<time>\d{4}(?:-\d\d){5})(?:_(?P<file>.+)|\.txt)", re.DOTALL
)  # a receipt has no file
BRIGHTSPACE = re.compile(r"\d+-\d+ - ")
DATE = re.compile(
    r" - (?P<month>[A-Z][a-z]{2}) (?P<day>\d\d?), (?P<year>\d{4}) "
    r"(?P<hour>\d\d?)(?P<minute>\d\d)(?: (?P<half>[AP]M))?(?= - |\Z)"
)
MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
ATTACHMENTS, FEEDBACK = "Submission attachment(s)", "Feedback Attachment(s)"  # of Sakai
LINE = 1000  # characters of a line that is read
TIME, TEXT = "timestamp.txt", "_submissionText.html"

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
        is_receipt: whether the system writes one for each attempt; where a file came with it, it says nothing.
        system: the system, if the name says it.
        time: when it was handed in, in ISO 8601, if the system says it; Gradescope alone says in which time zone.
    """

    path: Path
    keys: IdentityKeys
    order: tuple[str, ...] = ()
    late: bool = False
    is_submission: bool = True
    name: str = ""
    doubt: str = ""
    is_receipt: bool = False
    system: str = ""
    time: str = ""

    @property
    def own_name(self) -> str:
        """What its student called it."""
        return self.name or self.path.name

    @property
    def listed_name(self) -> str:
        """What the system called it."""
        return (self.name if self.system == "sakai" and self.path.is_dir() else "") or self.path.name


def read_names(folder: Path) -> list[DownloadedItem]:
    """Return what the names in a folder say: an item for each member of a group, and none for what the system added."""
    children = [child for child in sorted(folder.iterdir()) if not is_ignored(child.name)]
    items = _without_doubtful_groups([item for child in children for item in _read_name(child)])
    added = frozenset[str]().union(*(ADDED.get(item.system, ()) for item in items))
    return [item for item in items if item.path.name not in added]


def _read_name(path: Path) -> list[DownloadedItem]:
    """Return what the name of a file or folder says; nothing if it is a student's folder without a submission."""
    if places := _cuts(path, MOODLE):
        return [_read_moodle(path, places)]
    if found := BLACKBOARD.fullmatch(path.name):
        return [_read_blackboard(path, found)]
    begin = BRIGHTSPACE.match(path.name)
    if begin and (places := _cuts(path, DATE, begin.end())) and all(place["month"] in MONTHS for place in places):
        return [_read_brightspace(path, begin.end(), places)]
    if found := CANVAS.fullmatch(path.name):
        late = bool(found["late"])
        order = ("late",) if late else ("",)
        return [DownloadedItem(path, (("id", found["id"]),), order, late, name=found["file"], system="canvas")]
    if members := _members(path):
        return [replace(item, keys=keys) for item in _read_sakai(path) for keys in members]
    stem = student_of(path)
    return [DownloadedItem(path, tuple((kind, stem) for kind in ANY_KIND))]


def _cuts(path: Path, pattern: re.Pattern[str], start: int = 0) -> list[re.Match[str]]:
    """Return where a name may end and that of a file begin; one place, if the name of a file is missing.

    Students choose what stands before and after it. Of several places, the roster says which one is right.
    """
    places = [place for place in pattern.finditer(path.name, start) if place.start() > start]
    return places[-1:] if places and path.name[places[-1].end() :] in ("", "_") else places


def _read_moodle(path: Path, places: list[re.Match[str]]) -> DownloadedItem:
    """Return what a name of Moodle says: of several readings, one whose number and name are those of one student."""
    first, names = places[0], [path.name[: place.start()] for place in places]
    keys: IdentityKeys = (("identifier", first["id"]), ("name", names[0]))
    if len(places) > 1:
        keys = tuple(
            ("identifier and name", f"{place['id']} {name}") for place, name in zip(places, names, strict=True)
        )
    return DownloadedItem(path, keys, is_submission=first["kind"] == "file", name=path.name[first.end() + 1 :])


def _read_brightspace(path: Path, start: int, places: list[re.Match[str]]) -> DownloadedItem:
    """Return what a name of Brightspace says; of several readings, one whose name is that of one student."""
    who = [path.name[start : place.start()] for place in places]
    keys = _people(who[0]) if len(who) == 1 else tuple(("name", name) for name in who)
    name = path.name[places[0].end() :].removeprefix(" - ")
    time = _time(places[0])
    return DownloadedItem(path, keys, (time,), name=name, system="brightspace", time=time)


def _read_blackboard(path: Path, found: re.Match[str]) -> DownloadedItem:
    """Return what a name of Blackboard says, and whose it is by the receipt: names of courses and students hold `_`."""
    login, file = _login(path.with_name(f"{found['head']}_attempt_{found['time']}.txt")), found["file"] or ""
    known = bool(login) and found["head"].endswith(f"_{login}")
    return DownloadedItem(
        path,
        tuple((kind, login) for kind in ("login", "number", "email", "id")) if known else (),
        (found["time"],),
        is_submission=bool(file),
        name=file,
        doubt="" if known else "unclear: Blackboard's receipt beside it is missing, or names somebody else",
        is_receipt=not file,
        system="blackboard",
        time="{}-{}-{} {}:{}:{}".format(*found["time"].split("-")),
    )


def _login(receipt: Path) -> str:
    """Return whom the first line of a receipt of Blackboard names, `Name: Jane Doe (jdoe3)`; empty if nobody."""
    try:
        with receipt.open(encoding="utf-8", errors="replace") as file:
            name, _, login = file.readline(LINE).strip().rpartition("(")
    except OSError:
        return ""
    return login.removesuffix(")") if name.startswith("Name:") else ""


def _time(found: re.Match[str]) -> str:
    """Return the time in a name of Brightspace, in a form whose order is that of time."""
    hour, month = int(found["hour"]), MONTHS.index(found["month"]) + 1
    if found["half"]:
        hour = hour % 12 + 12 * (found["half"] == "PM")
    return f"{found['year']}-{month:02}-{int(found['day']):02} {hour:02}:{found['minute']}"


def _people(who: str) -> IdentityKeys:
    """Return the keys in a name of Brightspace: a student's name, behind that of a group if there is one."""
    return ("name", who), ("number", who), ("login", who), ("name", who.rpartition(" - ")[2])


def _members(path: Path) -> list[IdentityKeys]:
    """Return the keys of each member whom a name of Sakai holds: `Doe, Jane(jdoe3); Roe, Bob(broe)`."""
    whole = path.name if path.is_dir() else path.name.partition(f"_{ATTACHMENTS}_")[0].removesuffix(f"_{TEXT}")
    if not path.is_dir() and path.name.count(f"_{ATTACHMENTS}_") > 1:  # one is in the name of a student or of a file
        return []
    found: list[IdentityKeys] = []
    for member in whole.split("; "):
        name, bracket, account = member.rpartition("(")
        if not (bracket and account.endswith(")") and "," in name):
            return []
        kinds = ("id", "login", "number", "email")
        found.append((*((kind, account[:-1]) for kind in kinds), ("name", name)))
    return found if whole != path.name or path.is_dir() else []


def _without_doubtful_groups(items: list[DownloadedItem]) -> list[DownloadedItem]:
    """Return the items, but those of Sakai's groups as nobody's of whom a member has a submission of their own.

    Sakai writes a group as it writes a student whose own name holds that of another one.
    """
    paths = [item.path for item in items]
    groups = [item for item in items if item.system == "sakai" and paths.count(item.path) > 1]
    alone = {item.keys[:1] for item in items if item not in groups}
    doubtful = {item.path for item in groups if item.keys[:1] in alone}
    doubt = "unclear: a member of this group has a submission of their own, too"
    return [replace(item, keys=(), doubt=doubt) if item.path in doubtful else item for item in items]


def _read_sakai(path: Path) -> list[DownloadedItem]:
    """Return the submission in a student's folder, or what a file without folders is; the keys are not yet there."""
    if not path.is_dir():
        file = path.name.partition(f"_{ATTACHMENTS}_")[2]
        return [DownloadedItem(path, (), is_submission=bool(file), name=file, is_receipt=not file, system="sakai")]
    # The folder has another name where Sakai speaks another language.
    folders = [child for child in sorted(path.iterdir()) if child.is_dir() and child.name != FEEDBACK]
    filled = [child for child in folders if any(child.iterdir())]
    if len(filled) == 1:
        return [DownloadedItem(filled[0], (), name=path.name, system="sakai")]
    if not filled and not (path / TIME).is_file():
        return []
    return [DownloadedItem(path, (), is_submission=False, system="sakai")]


def resubmitted(items: Sequence[DownloadedItem]) -> list[DownloadedItem]:
    """Return the files of Canvas that a later attempt replaces: `answer.zip` if there is `answer-1.zip`, too.

    The numbers of files say nothing: each file of an attempt has one of its own.
    """
    versions: dict[str, dict[int, DownloadedItem]] = {}
    for item in items:
        if item.system != "canvas":
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
        time = str(entry.get(":created_at", ""))
        yield DownloadedItem(folder, keys, (time,), time=time)
