"""Writes the zip of feedback pages that Moodle or Canvas returns to students. File names identify the student.

Moodle ("Upload multiple feedback files in a zip"; mod/assign/feedback/file/importziplib.php): a path contains
NAME_NUMBER_assignsubmission_file_, as in a download of submissions, and then the name of the feedback file. NUMBER is
the participant's number, and NAME must not contain an underscore.

Canvas ("Re-Upload Submissions"; app/models/abstract_assignment.rb, `infer_comment_context_from_filename`): a file has
the same name as in the download. The first two numbers between underscores are the ids of the user and of an attachment
of the submission. The student gets the feedback under the name of the submitted file, so it has the same type: a zip or
tar with the page, a page, or a notebook with the feedback as text.
"""

from __future__ import annotations

import io
import re
import tarfile
import tempfile
import zipfile
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import nbformat

from autograder.exceptions import UsageError
from autograder.lms.collect import newest_items
from autograder.lms.roster import PARTICIPANT, Roster, normalized
from autograder.lms.submission_names import DownloadedItem
from autograder.report import feedback
from autograder.report.export.formats import markdown
from autograder.result.model import Result
from autograder.submission.intake.names import is_notebook

FORBIDDEN = re.compile(r'[_/\\:*?"<>|\x00-\x1f]+')
MAX_NAME = 100  # characters of a student's name
# Modes of `tarfile.open`, by the endings of file names.
TAR = {
    **{".tar": "w", ".tar.gz": "w:gz", ".tgz": "w:gz", ".tar.bz2": "w:bz2", ".tbz2": "w:bz2", ".tbz": "w:bz2"},
    **{".tar.xz": "w:xz", ".txz": "w:xz"},
}


@dataclass(frozen=True)
class FeedbackPaths:
    """The path of each student's feedback in the zip, and a pair (student, reason) for each student without one."""

    by_student: Mapping[str, str]
    left_out: tuple[tuple[str, str], ...]


def moodle_paths(roster: Roster, students: Iterable[str]) -> FeedbackPaths:
    """Return the paths of students' feedback in Moodle's zip. Raises UsageError if the table is not from Moodle."""
    columns = [normalized(heading) for heading in roster.headings]
    if "identifier" not in columns:
        raise UsageError(f"{roster.path}: the column 'identifier' is missing; give the grading worksheet of Moodle")
    rows = {student.id: dict(zip(columns, roster.rows[student.row], strict=False)) for student in roster.students}
    by_student, left_out = {}, []
    for student in students:
        number = normalized(rows.get(student, {}).get("identifier", "")).removeprefix(PARTICIPANT)
        if number.isascii() and number.isdigit():
            name = FORBIDDEN.sub(" ", rows[student].get("full name", ""))[:MAX_NAME].strip() or PARTICIPANT.strip()
            by_student[student] = f"{name}_{number}_assignsubmission_file_/{feedback.PAGE}"
        else:
            left_out.append((student, f"{roster.path.name} has no identifier `Participant NUMBER` for this student"))
    return FeedbackPaths(by_student, tuple(left_out))


def canvas_paths(folder: Path, roster: Roster, assignment: str, students: Iterable[str]) -> FeedbackPaths:
    """Return the path of each student's feedback in Canvas's zip. The path is the name of a submitted file.

    Args:
        folder: the unpacked download of the submissions.
        roster: the exported gradebook.
        assignment: the assignment's name in the course.
        students: the students who get feedback.
    """
    newest = newest_items(folder, roster, assignment)
    by_student, left_out = {}, []
    for student in students:
        recognized_names = [item.path.name for item in newest.get(student, ()) if _is_recognized(item)]
        ranked_names = sorted((rank, name) for name in recognized_names if (rank := _rank(name)) is not None)
        if ranked_names:
            by_student[student] = ranked_names[0][1]
        else:
            left_out.append(
                (student, "the download has no page, archive or notebook of this student that Canvas accepts again")
            )
    return FeedbackPaths(by_student, tuple(left_out))


def write_archive(results: Collection[Result], paths: FeedbackPaths, out: Path) -> None:
    """Write the zip with the feedback on `results`, replacing an old one only when it is complete."""
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".feedback-") as scratch:
        new_zip = Path(scratch) / "feedback.zip"
        with zipfile.ZipFile(new_zip, "w", zipfile.ZIP_DEFLATED) as archive:
            for result in results:
                if (name := paths.by_student.get(result.student)) is not None:
                    archive.writestr(_zip_entry(name), _feedback_file(name, result, Path(scratch)))
        new_zip.replace(out)


def _zip_entry(name: str) -> zipfile.ZipInfo:
    """Return a zip entry that is readable by everyone and has a fixed time."""
    member = zipfile.ZipInfo(name)
    member.compress_type, member.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
    return member


def _feedback_file(name: str, result: Result, scratch: Path) -> bytes:
    """Return a result's feedback as a file of the type that `name` indicates. `scratch` is for temporary files."""
    if is_notebook(name):
        return _notebook(result, scratch)
    lower_name, page = name.casefold(), feedback.write(result, scratch, artifacts=result.folder).read_bytes()
    if lower_name.endswith(".zip"):
        return _zip(page)
    mode = next((mode for ending, mode in TAR.items() if lower_name.endswith(ending)), None)
    return page if mode is None else _tar(page, mode)


def _rank(name: str) -> int | None:
    """Return how suitable a file with this name is for feedback, 0 being the best, or None if it is unsuitable."""
    lower_name = name.casefold()
    kinds = ((".html", ".htm"), (".zip",), tuple(TAR))
    return next(
        (rank for rank, endings in enumerate(kinds) if lower_name.endswith(endings)), 3 if is_notebook(name) else None
    )


def _is_recognized(item: DownloadedItem) -> bool:
    """Return whether Canvas recognizes the user in the file's name, and does not treat it as a link."""
    *parts, last = item.path.name.split("_")
    numbers = [part for part in parts if part.isascii() and part.isdigit()]
    return item.system == "canvas" and ("id", numbers[0]) in item.keys and not last.startswith("link")


def _zip(page: bytes) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr(_zip_entry(feedback.PAGE), page)
    return data.getvalue()


def _tar(page: bytes, mode: str) -> bytes:
    data, member = io.BytesIO(), tarfile.TarInfo(feedback.PAGE)
    member.size = len(page)
    with tarfile.open(fileobj=data, mode=mode) as archive:  # type: ignore[call-overload]
        archive.addfile(member, io.BytesIO(page))
    return data.getvalue()


def _notebook(result: Result, scratch: Path) -> bytes:
    text = markdown.write([result], scratch / "feedback.md").read_text(encoding="utf-8")
    cell = nbformat.v4.new_markdown_cell(text, id="feedback")
    return str(nbformat.writes(nbformat.v4.new_notebook(cells=[cell]))).encode()
