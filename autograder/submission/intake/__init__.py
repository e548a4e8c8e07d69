"""Reads a submission into memory, and finds the part that counts. It executes nothing.

A submission is the folder of an assignment (the notebook and `ws/` beside it), a zip or tar archive of such a folder,
the notebook alone, or a source tree with `src/`. It may be in nested folders or archives, under another name and beside
other files. Links, devices, absolute paths and paths with `..` are refused, or skipped if they are not needed. The
number, size and depth of files are limited, and so are the time and the memory of reading them. Files that tools leave
behind are ignored.

    path -> reading -> files -> answer (which notebook and source tree) -> counting (files in `ws/src`, else cells)
"""

from __future__ import annotations

import hashlib
import stat
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.submission.intake.answer import Answer, broken_sentence, find_answer
from autograder.submission.intake.bounds import bounded
from autograder.submission.intake.counting import GradedPackages, count, merge, read_code, with_given
from autograder.submission.intake.exercises import SOURCE, exercises_of
from autograder.submission.intake.files import (
    MAX_DEPTH,
    MAX_FILE_BYTES,
    MAX_FILES,
    MAX_PATH_BYTES,
    MAX_TOTAL_BYTES,
    MAX_WRAPPED_BYTES,
    SkippedFile,
    SubmittedFile,
    digest,
    unsafe,
    write_tree,
)
from autograder.submission.intake.reading import read_contents, read_source_folder
from autograder.submission.reading import reading as student_data

__all__ = [
    "MAX_DEPTH",
    "MAX_FILES",
    "MAX_FILE_BYTES",
    "MAX_PATH_BYTES",
    "MAX_TOTAL_BYTES",
    "MAX_WRAPPED_BYTES",
    "SkippedFile",
    "Submission",
    "SubmittedFile",
    "detect_layout",
    "graded_packages",
    "read_files",
    "read_packages",
    "read_submission",
    "with_given_packages",
    "write_tree",
]
TIMESTAMP = PurePosixPath("timestamp.txt")  # written by nbgrader
MAX_LISTED = 20  # unused files whose names are listed


@dataclass(frozen=True)
class Submission:
    """The files of a submission, in the layout that grading uses."""

    notebook: bytes | None  # content of the assignment's notebook, or None
    source: tuple[SubmittedFile, ...]  # files below `ws/src`, with paths relative to it
    # Other files that the notebook may read, with paths relative to the assignment's folder.
    extra: tuple[SubmittedFile, ...]
    sha256: str  # hexadecimal digest of the paths and contents of all files
    graded_sha256: str  # digest of the files that a grading reads; the same for a folder and for a zip of it
    # The packages that are graded, with paths relative to `ws/src`; None if the notebook has to create some of them.
    packages: tuple[SubmittedFile, ...] | None = None
    notices: tuple[str, ...] = ()  # sentences for the student about the files that count
    unused: tuple[str, ...] = ()  # paths of files that do not count, or sentences about skipped files


def read_packages(root: Path) -> tuple[SubmittedFile, ...]:
    """Read the files in `root`/src, with paths relative to it. A student's code may have changed the workspace `root`.

    Raises:
        StudentError: `src` is not a folder, or contains unsafe files.
    """
    for folder in (root, root / "src"):
        try:
            mode = folder.lstat().st_mode
        except OSError:
            mode = 0
        if not stat.S_ISDIR(mode):
            sentence = "After the notebook has run, there is no folder ws/src: create your package there."
            raise StudentError(Diagnosis(Kind.NOTHING_SUBMITTED, sentence))
    return read_source_folder(root / "src")


def read_submission(path: Path, assignment: str) -> Submission:
    """Read a submission of an assignment from disk: a folder, an archive or a notebook.

    Raises:
        UsageError: `path` does not exist.
        StudentError: the submission is unsafe, unreadable or unclear, or has neither the notebook nor a package.
    """
    with student_data("Your submission"), bounded():
        contents = read_contents(path, assignment)
        return detect_layout(contents.files, assignment, contents.skipped)


def read_files(path: Path, assignment: str) -> list[SubmittedFile]:
    """Read all files of a submission, with paths relative to its root.

    The arguments and errors are those of `read_submission`.
    """
    with student_data("Your submission"), bounded():
        contents = read_contents(path, assignment)
        detect_layout(contents.files, assignment, contents.skipped)
        return contents.files


def detect_layout(files: Sequence[SubmittedFile], assignment: str, skipped: Sequence[SkippedFile] = ()) -> Submission:
    """Find the notebook and the packages among a submission's files, whose paths are relative to its root.

    Raises:
        StudentError: the submission has neither the notebook nor a package, is unclear or unsafe, or contains a file
            and a folder with the same path.
    """
    _require_tree(files)
    exercises = exercises_of(assignment)
    answer = find_answer(files, skipped, assignment, exercises)
    source = tuple(answer.tree.files.values()) if answer.tree is not None else ()
    extra = _extra(files, answer)
    notebook = None if answer.notebook is None else answer.notebook.file.data
    graded = GradedPackages(source)
    if answer.notebook is not None and answer.notebook.broken:
        notebook, graded = None, GradedPackages(source, (f"{broken_sentence(answer.notebook)} ws/src counts.",))
    elif answer.notebook is not None:
        graded = GradedPackages(None)
        if exercises is not None:
            code = read_code(answer.notebook.cells, exercises)
            graded = count({file.path: file for file in source}, code, exercises)
    return Submission(
        notebook,
        source,
        extra,
        digest(files),
        _graded_digest(notebook, source, extra, graded.packages, assignment),
        graded.packages,
        graded.notices,
        _unused_names(files, skipped, answer, assignment),
    )


def with_given_packages(submission: Submission, assignment: str) -> tuple[SubmittedFile, ...]:
    """Return the source tree in which the notebook of a submission runs."""
    exercises = exercises_of(assignment)
    source = {file.path: file for file in submission.source}
    return tuple((source if exercises is None else with_given(source, exercises)).values())


def graded_packages(submission: Submission, written: Sequence[SubmittedFile], assignment: str) -> GradedPackages:
    """Return the packages that are graded, after the notebook has written the files `written` to its `ws/src`."""
    exercises = exercises_of(assignment)
    if exercises is None:
        return GradedPackages(tuple(written))
    return merge({file.path: file for file in submission.source}, written, exercises)


def _extra(files: Sequence[SubmittedFile], answer: Answer) -> tuple[SubmittedFile, ...]:
    """Return the files besides the notebook and the source tree that the notebook may read."""
    if answer.notebook is not None:
        root = answer.notebook.root
    elif answer.tree is not None:
        root = answer.tree.root
    extra = []
    for file in files:
        if file.path == root or not file.path.is_relative_to(root):
            continue
        path = file.path.relative_to(root)
        is_source = answer.tree is not None and answer.tree.contains(file.path)
        is_notebook = answer.notebook is not None and file.path == answer.notebook.file.path
        if not (is_source or is_notebook or path.parts[0] in ("ws", "src")):
            extra.append(SubmittedFile(path, file.data, file.executable))
    return tuple(extra)


def _graded_digest(
    notebook: bytes | None,
    source: Sequence[SubmittedFile],
    extra: Sequence[SubmittedFile],
    packages: Sequence[SubmittedFile] | None,
    assignment: str,
) -> str:
    """Return the digest of the files that a grading reads.

    Its first word keeps a grading of packages apart from one that runs a notebook, which may read equal files.
    """
    if packages is None:
        kind, files = "notebook", _graded_files(notebook, source, extra, assignment)
    else:
        kind, files = "packages", list(packages)
    return hashlib.sha256(f"{kind} {digest(files)}".encode()).hexdigest()


def _graded_files(
    notebook: bytes | None, source: Sequence[SubmittedFile], extra: Sequence[SubmittedFile], assignment: str
) -> list[SubmittedFile]:
    """Return the files that a grading with the notebook reads, in the same layout for all submissions."""
    graded = [*extra, *(replace(file, path=SOURCE / file.path) for file in source)]
    if notebook is not None:
        graded.append(SubmittedFile(PurePosixPath(f"{assignment}.ipynb"), notebook))
    return graded


def _unused_names(
    files: Sequence[SubmittedFile],
    skipped: Sequence[SkippedFile],
    answer: Answer,
    assignment: str,
) -> tuple[str, ...]:
    """Return the names of files that do not count, with the reason for each skipped file."""
    notebook = answer.notebook.file.path if answer.notebook is not None else None
    root = notebook.parent if notebook is not None else answer.tree.root if answer.tree is not None else PurePosixPath()
    exercises = exercises_of(assignment)
    released_paths = exercises.other_files if exercises is not None else frozenset()
    names = []
    for file in files:
        relative_path = file.path.relative_to(root) if file.path.is_relative_to(root) else file.path
        is_source = answer.tree is not None and answer.tree.contains(file.path)
        if not (
            is_source
            or file.path == notebook
            or relative_path in released_paths
            or relative_path.parts[0] == "ws"
            or relative_path == TIMESTAMP
        ):
            names.append(str(file.path))
    names = sorted(names) + [file.sentence for file in skipped]
    unlisted_count = len(names) - MAX_LISTED
    return tuple(names if unlisted_count <= 0 else [*names[:MAX_LISTED], f"{unlisted_count} more"])


def _require_tree(files: Sequence[SubmittedFile]) -> None:
    """Refuse two files with the same path, and a file whose path is also that of a folder."""
    paths = {file.path for file in files}
    folders = {folder for path in paths for folder in path.parents}
    if len(paths) < len(files) or paths & folders:
        raise unsafe("two of its files or folders have the same path")
