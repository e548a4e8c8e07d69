"""Finds each student's submission in a download. The newest attempt counts, with all of its files.

Items that match no student are listed, not ignored.
"""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from collections.abc import Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.grade.batch import submission_in
from autograder.lms.clones import FOLDER_SUFFIX, account_in, assignment_of, prefixes
from autograder.lms.roster import Roster
from autograder.lms.submission_names import METADATA, DownloadedItem, read_metadata, read_names, resubmitted
from autograder.result.class_folder import folder_name_problem
from autograder.submission.intake.ignored import is_ignored
from autograder.submission.intake.names import is_archive, is_notebook


@dataclass(frozen=True)
class CollectedSubmissions:
    """The submissions in a download, in the order of the roster.

    Attributes:
        submissions: the newest submission of each student; the members of a group share a path.
        late: students whose submission the system marks as late.
        older: names of submissions that the same student replaced by a newer one.
        unmatched: pairs (name, reason) of items that match no student or are not submissions.
        missing: students without a submission.
        times: the time of each student's submission in ISO 8601, if the system states it.
        late_by: the delay of each student according to Moodle's table, in seconds.
    """

    submissions: Mapping[str, Path]
    late: tuple[str, ...]
    older: tuple[str, ...]
    unmatched: tuple[tuple[str, str], ...]
    missing: tuple[str, ...]
    times: Mapping[str, str]
    late_by: Mapping[str, int]


@contextmanager
def unpacked(download: Path) -> Iterator[Path]:
    """Yield the folder of a download. A zip is unpacked to a temporary folder.

    Raises UsageError if the download is neither a folder nor a zip, or if the zip contains a path outside of itself.
    """
    if download.is_dir():
        yield download
        return
    with tempfile.TemporaryDirectory(prefix="handed-in-") as folder:
        try:
            with zipfile.ZipFile(download) as archive:
                outside_names = [name for name in archive.namelist() if name.startswith("/") or ".." in name.split("/")]
                if outside_names:  # `extractall` would change the name, perhaps to another student's
                    raise ValueError(f"{outside_names[0]} points outside the archive")
                archive.extractall(folder)
        except (OSError, zipfile.BadZipFile, NotImplementedError, RuntimeError, ValueError) as error:
            raise UsageError(f"{download}: not a folder, and not a readable zip: {error}") from None
        yield Path(folder)


def collect(folder: Path, roster: Roster, assignment: str, scratch: Path) -> CollectedSubmissions:
    """Find each student's submission in an unpacked download.

    In nbgrader's layout, a student's folder contains a folder with the assignment's name. If an attempt has several
    files, they are copied to a folder in `scratch`.
    """
    submitted, unmatched = _by_student(folder, roster, assignment)
    newest = {name: _newest_attempt(attempts) for name, attempts in submitted.items()}
    students = [student for student in roster.students if student.id in newest]
    times = {student.id: max(item.time for item in newest[student.id]) for student in students}
    return CollectedSubmissions(
        {student.id: _submission_path(newest[student.id], assignment, scratch) for student in students},
        tuple(student.id for student in students if student.late or any(item.late for item in newest[student.id])),
        tuple(item.listed_name for name, items in submitted.items() for item in items if item not in newest[name]),
        tuple(unmatched),
        tuple(student.id for student in roster.students if student.id not in newest),
        {name: time for name, time in times.items() if time},
        {student.id: student.late_by for student in students if student.late_by is not None},
    )


def newest_items(folder: Path, roster: Roster, assignment: str) -> dict[str, list[DownloadedItem]]:
    """Return the files and folders of each student's newest attempt in an unpacked download."""
    submitted, _ = _by_student(folder, roster, assignment)
    return {name: _newest_attempt(attempts) for name, attempts in submitted.items()}


def _by_student(
    folder: Path, roster: Roster, assignment: str
) -> tuple[dict[str, list[DownloadedItem]], list[tuple[str, str]]]:
    """Return the items of all attempts by student, and pairs (name, reason) of items that are not submissions."""
    items, unmatched = _items(folder, roster, assignment)
    submitted: dict[str, list[DownloadedItem]] = {}
    texts: list[tuple[str, DownloadedItem]] = []
    for item in items:
        student = roster.find(item.keys)
        if student is None:
            unmatched.append((item.listed_name, item.ambiguity or f"it matches no student in {roster.path.name}"))
        elif reason := folder_name_problem(student.id):
            unmatched.append((item.listed_name, f"{reason} in {roster.path.name}"))
        elif not item.is_submission:
            texts.append((student.id, item))
        else:
            submitted.setdefault(student.id, []).append(item)
    for name, text in texts:
        orders = {item.order for item in submitted.get(name, ())}
        if not (text.is_receipt and text.order in orders):
            unmatched.append((text.listed_name, "it is not a submitted file"))
    return submitted, unmatched


def _items(folder: Path, roster: Roster, assignment: str) -> tuple[list[DownloadedItem], list[tuple[str, str]]]:
    if (folder / METADATA).is_file():
        return read_metadata(folder)
    items = _with_accounts(read_names(folder), folder, roster, assignment)
    # A zip often contains a single top-level folder.
    if len(items) == 1 and items[0].path.is_dir() and not _is_submission(items[0], folder, roster):
        return _items(items[0].path, roster, assignment)
    return items, []


def _is_submission(item: DownloadedItem, folder: Path, roster: Roster) -> bool:
    """Return whether the only item of a download is a submission, rather than a folder with all submissions."""
    return bool(item.ambiguity) or roster.find(item.keys) is not None or folder.resolve().name.endswith(FOLDER_SUFFIX)


def _with_accounts(items: list[DownloadedItem], folder: Path, roster: Roster, assignment: str) -> list[DownloadedItem]:
    """Treat folders whose whole name matches no student as clones, and add the account to their keys."""
    clones = [item for item in items if item.path.is_dir() and roster.find(item.keys) is None]
    accounts = {value for student in roster.students for kind, value in student.keys if kind == "github"}
    names = [item.path.name for item in clones]
    prefix = assignment_of(names, folder.resolve().name, assignment, accounts)
    return [_with_account(item, prefix, accounts) if item in clones else item for item in items]


def _with_account(item: DownloadedItem, prefix: str | None, accounts: Set[str]) -> DownloadedItem:
    name = item.path.name
    if prefix is not None:
        return replace(item, keys=(("github", account_in(name, prefix)),))
    candidates = [account for start in prefixes(name) if (account := account_in(name, start)) in accounts]
    if not candidates:
        return item
    ambiguity = (
        f"unclear: {' or '.join(candidates)}, or another account with this ending; name the folder of the clones "
        f"ASSIGNMENT{FOLDER_SUFFIX}, as `gh classroom clone` does"
    )
    return replace(item, ambiguity=ambiguity)


def _newest_attempt(items: Sequence[DownloadedItem]) -> list[DownloadedItem]:
    """Return the files and folders of a student's newest attempt."""
    latest = max(item.order for item in items)
    attempt = [item for item in items if item.order == latest]
    replaced_items = resubmitted(attempt)
    return [item for item in attempt if item not in replaced_items]


def _submission_path(attempt: Sequence[DownloadedItem], assignment: str, scratch: Path) -> Path:
    """Return the path of an attempt. A folder that contains only an archive or a notebook is replaced by that file."""
    if len(attempt) > 1:
        folder = Path(tempfile.mkdtemp(dir=scratch))
        for number, item in enumerate(attempt):
            target = folder / item.original_name
            if target.exists():
                target = folder / f"{number} {item.original_name}"
            if item.path.is_dir():
                shutil.copytree(item.path, target, symlinks=True)
            else:
                shutil.copy2(item.path, target, follow_symlinks=False)
        return folder
    path = attempt[0].path
    if path.is_file():
        return path
    children = [child for child in path.iterdir() if not is_ignored(child.name)]
    if len(children) == 1 and (is_archive(children[0].name) or is_notebook(children[0].name)):
        return children[0]
    return submission_in(path, assignment)
