"""Finds and reads the files of a submission: in a folder, in archives, and in nested archives."""

from __future__ import annotations

import errno
import io
import os
import stat
from pathlib import Path, PurePosixPath
from typing import IO

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError, UsageError
from autograder.submission.intake import archives
from autograder.submission.intake.files import MAX_DEPTH, Contents, SubmittedFile, unsafe
from autograder.submission.intake.ignored import environment_parts, is_ignored
from autograder.submission.intake.names import is_archive, is_notebook, reading_rank

MAX_ARCHIVES = 20  # in a submission, at any depth
MAX_NESTING = 3  # levels of archives in archives that are opened
_EXECUTABLE = 0o100


def read_contents(path: Path, assignment: str) -> Contents:
    """Read the files of a submission, with paths relative to its root. Those of an inner archive begin with its path.

    Raises:
        UsageError: `path` does not exist.
        StudentError: the submission cannot be read, or is unsafe as a whole.
    """
    contents = Contents()
    if path.is_dir():
        _read_folder(path, contents, unpack=True)
    elif path.is_file() and is_notebook(path.name):
        contents.add(PurePosixPath(f"{assignment}.ipynb"), path.stat().st_size, path.read_bytes)
    elif path.is_file():
        _read_file(path, contents)
    else:
        raise UsageError(f"{path}: there is no such file or folder")
    _open_archives(contents, MAX_NESTING)
    return contents


def read_source_folder(folder: Path) -> tuple[SubmittedFile, ...]:
    """Read the files below a folder. Raises StudentError if one of them is unsafe."""
    contents = Contents()
    _read_folder(folder, contents)
    if contents.skipped:
        raise unsafe(contents.skipped[0].sentence)
    return tuple(contents.files)


def _read_file(path: Path, contents: Contents) -> None:
    with path.open("rb") as file:
        kind = archives.unsupported_kind(file.read(8))
        if kind:
            raise StudentError(Diagnosis(Kind.UNREADABLE, f"{archives.unsupported_sentence(path.name, kind)}."))
        file.seek(0)
        try:
            archives.read_archive(file, path.name, PurePosixPath(), contents)
        except archives.READ_ERRORS as error:
            sentence = (
                f"{path.name} is not a folder, a notebook or a readable zip or tar archive ({error}): hand in one of "
                "these."
            )
            raise StudentError(Diagnosis(Kind.UNREADABLE, sentence)) from None


def _read_folder(root: Path, contents: Contents, *, unpack: bool = False) -> None:
    """Read the files below a folder. With `unpack`, replace archives with the files in them."""
    pending, files = [root], []
    while pending:
        folder = pending.pop()
        children = sorted(folder.iterdir())
        environment = environment_parts(child.name for child in children)
        for child in children:
            contents.scan()
            if is_ignored(child.name) or child.name in environment:
                continue
            path, info = PurePosixPath(child.relative_to(root)), _status(child)
            if info is None:
                contents.skip(path, f"the path {str(path)[:60]!r}... is longer than this system can open")
            elif stat.S_ISREG(info.st_mode):
                files.append((path, child, info))
            elif not stat.S_ISDIR(info.st_mode):
                kind = "a symbolic link" if stat.S_ISLNK(info.st_mode) else "not a regular file"
                contents.skip(path, f"{path} is {kind}")
            elif len(path.parts) > MAX_DEPTH:
                contents.skip(path, f"folders are nested more than {MAX_DEPTH} deep")
            else:
                pending.append(child)
    for path, child, info in sorted(files, key=lambda item: (reading_rank(item[0]), item[0])):
        if unpack and _may_contain_answer(path):
            with child.open("rb") as file:
                _unpack(file, path, contents)
        else:
            contents.add(path, info.st_size, child.read_bytes, bool(info.st_mode & _EXECUTABLE))


def _status(path: Path) -> os.stat_result | None:
    """Return the status of a path, or None if it is too long for the system."""
    try:
        return path.lstat()
    except OSError as error:
        if error.errno != errno.ENAMETOOLONG:
            raise
        return None


def _open_archives(contents: Contents, nesting: int) -> None:
    """Replace archives with the files in them."""
    packed = [file for file in contents.files if _may_contain_answer(file.path)]
    for file in packed:
        contents.remove(file)
        if nesting:
            _unpack(io.BytesIO(file.data), file.path, contents)
        else:
            sentence = f"{file.path} is nested in {MAX_NESTING} or more archives: hand in the folder as one zip"
            contents.skip(file.path, sentence)
    if packed and nesting:
        _open_archives(contents, nesting - 1)


def _may_contain_answer(path: PurePosixPath) -> bool:
    """Return whether a file is an archive that may contain an answer. An archive in a source tree is data."""
    return is_archive(path.name) and "src" not in path.parts


def _unpack(file: IO[bytes], path: PurePosixPath, contents: Contents) -> None:
    contents.archives += 1
    kind = archives.unsupported_kind(file.read(8))
    file.seek(0)
    count = len(contents.files)
    if contents.archives > MAX_ARCHIVES:
        contents.skip(path, f"{path} is one of more than {MAX_ARCHIVES} archives")
    elif kind:
        contents.skip(path, archives.unsupported_sentence(str(path), kind))
    else:
        try:
            archives.read_archive(file, path.name, path, contents)
        except (StudentError, *archives.READ_ERRORS) as error:
            contents.drop(count)
            contents.skip(path, f"{path} cannot be opened ({error})")
