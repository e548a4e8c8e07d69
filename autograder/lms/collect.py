"""Finds each student's submission in a download. The newest counts; what fits no student is listed, not dropped."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.grading.batch import ARCHIVES, Entry
from autograder.lms.roster import Roster
from autograder.lms.submission_names import METADATA, DownloadedItem, read_metadata, read_name

COLLECTION_REPORT = "handed_in.json"  # beside the results: the late students, and what fits no student
NOT_SUBMISSIONS = frozenset({"__MACOSX", ".DS_Store", METADATA})


@dataclass(frozen=True)
class CollectedSubmissions:
    """The submissions in a download, in the order of the roster.

    Attributes:
        entries: the newest submission of each student.
        late: the students whom the system calls late.
        older: the names of the submissions that a newer one of the same student replaces.
        unmatched: what fits no student or is no submission, as pairs of a name and the reason.
        missing: the students without a submission.
    """

    entries: tuple[Entry, ...]
    late: tuple[str, ...]
    older: tuple[str, ...]
    unmatched: tuple[tuple[str, str], ...]
    missing: tuple[str, ...]


@contextmanager
def unpacked(download: Path) -> Iterator[Path]:
    """Give the folder of a download; one that is a zip is unpacked until the block is left.

    Raises UsageError if it is neither a folder nor a zip, or names a file outside of itself.
    """
    if download.is_dir():
        yield download
        return
    with tempfile.TemporaryDirectory(prefix="handed-in-") as folder:
        try:
            with zipfile.ZipFile(download) as archive:
                outside = [name for name in archive.namelist() if name.startswith("/") or ".." in name.split("/")]
                if outside:  # it would land inside under another name, perhaps that of another student
                    raise ValueError(f"{outside[0]} points outside the archive")
                archive.extractall(folder)
        except (OSError, zipfile.BadZipFile, NotImplementedError, RuntimeError, ValueError) as error:
            raise UsageError(f"{download}: not a folder, and not a readable zip: {error}") from None
        yield Path(folder)


def collect(folder: Path, roster: Roster, assignment: str) -> CollectedSubmissions:
    """Find each student's submission in an unpacked download.

    In nbgrader's layout, the folder of a student holds one with the name of the assignment.
    """
    newest: dict[str, DownloadedItem] = {}
    older: list[str] = []
    unmatched: list[tuple[str, str]] = []
    for item in _items(folder, roster):
        student = roster.find(item.keys)
        if student is None:
            unmatched.append((item.path.name, f"no student of {roster.path.name} fits"))
        elif not item.is_submission:
            unmatched.append((item.path.name, "it is no file that was handed in"))
        elif student.id not in newest:
            newest[student.id] = item
        elif item.order == newest[student.id].order:
            unmatched.append((item.path.name, f"{student.id} handed in several, and none is the newest"))
        else:
            older.append(min(item, newest[student.id], key=lambda item: item.order).path.name)
            newest[student.id] = max(item, newest[student.id], key=lambda item: item.order)
    students = [student.id for student in roster.students]
    late = {student.id for student in roster.students if student.late}
    return CollectedSubmissions(
        tuple(Entry(name, _submission(newest[name].path, assignment)) for name in students if name in newest),
        tuple(name for name in students if name in newest and (newest[name].late or name in late)),
        tuple(older),
        tuple(unmatched),
        tuple(name for name in students if name not in newest),
    )


def _items(folder: Path, roster: Roster) -> list[DownloadedItem]:
    if (folder / METADATA).is_file():
        return read_metadata(folder)
    items = [read_name(child) for child in sorted(folder.iterdir()) if child.name not in NOT_SUBMISSIONS]
    # A zip often holds one folder that holds all.
    if len(items) == 1 and items[0].path.is_dir() and roster.find(items[0].keys) is None:
        return _items(items[0].path, roster)
    return items


def _submission(path: Path, assignment: str) -> Path:
    """Return the submission in what a student handed in: a folder that holds one archive alone means the archive."""
    if path.is_file():
        return path
    if (path / assignment).is_dir():
        return path / assignment
    inside = [child for child in path.iterdir() if child.name not in NOT_SUBMISSIONS]
    return inside[0] if len(inside) == 1 and inside[0].suffix in ARCHIVES else path
