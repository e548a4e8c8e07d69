"""Reads files that untrusted code may have written: plain files of a bounded size, and no links.

A check that searches files for something forbidden must not pass because a file could not be searched. So functions
that raise CheckFailed refuse such a file by its name, instead of returning nothing.
"""

from __future__ import annotations

import ast
import os
import stat
import warnings
from collections.abc import Collection
from contextlib import suppress
from pathlib import Path

from autograder.suite import CheckFailed


def read_plain(path: Path, limit: int) -> bytes | None:
    """Return a plain file's bytes, or None for a link, a pipe, a folder or a file of more than `limit` bytes."""
    with suppress(PermissionError):
        data = _read_start(path, limit + 1)
        return data if data is not None and len(data) <= limit else None
    return None


def read_limited(path: Path, limit: int, name: str) -> bytes:
    """Return a plain file's bytes; there are none for a link, a pipe, a folder or a missing file.

    Args:
        path: the file.
        limit: the maximum number of bytes.
        name: what a message calls the file.

    Raises:
        CheckFailed: the file is larger, or a build has made it unreadable.
    """
    try:
        data = _read_start(path, limit + 1) or b""
    except PermissionError as error:
        raise _unreadable(error) from None
    if len(data) > limit:
        raise CheckFailed(_too_large(name, limit))
    return data


def _read_start(path: Path, count: int) -> bytes | None:
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except PermissionError:
        raise
    except OSError:
        return None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        return None
    with os.fdopen(descriptor, "rb") as stream:
        return stream.read(count)


def read_below(folder: Path, name: Path, limit: int) -> bytes | None:
    """Return a file's bytes as `read_plain` does, or None if a link in its path leads out of the folder."""
    path = folder / name
    try:
        is_inside = path.parent.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # links form a cycle
        return None
    return read_plain(path, limit) if is_inside else None


def plain_files(folder: Path, limit: int, *, skip: Collection[str] = (), suffix: str = "") -> list[Path]:
    """Return the plain files below a folder, relative to it, in order. No link is followed, not even `folder` itself.

    Args:
        folder: the folder to search.
        limit: the maximum number of files.
        skip: folders that are not searched: names, or paths below `folder` that begin with a slash.
        suffix: the suffix of the files' names.

    Raises:
        CheckFailed: there are more files, or a build has made a folder unreadable.
    """
    files: list[Path] = []
    for parent, folders, names in os.walk(folder, onerror=_refuse_unreadable) if not folder.is_symlink() else ():
        below = parent.removeprefix(str(folder))
        folders[:] = sorted(name for name in folders if not {name, f"{below}/{name}"} & set(skip))
        paths = [Path(parent, name) for name in sorted(names) if name.endswith(suffix)]
        files += [path.relative_to(folder) for path in paths if stat.S_ISREG(path.lstat().st_mode)]
        if len(files) > limit:
            raise CheckFailed(
                f"The folder {folder.name} contains more than {limit} files{f' *{suffix}' if suffix else ''}, which is "
                "too many to search: keep generated files out of the package."
            )
    return files


def search_python(source: bytes, limit: int, name: str) -> ast.Module:
    """Parse Python source that a check has to search, in the encoding that Python itself would use.

    Args:
        source: the bytes of the file.
        limit: the maximum number of bytes.
        name: what a message calls the file.

    Raises:
        CheckFailed: there are more bytes, or it is not Python or too deeply nested.
    """
    if len(source) > limit:
        raise CheckFailed(_too_large(name, limit))
    tree = parse_python(source)
    if tree is None:
        raise CheckFailed(f"{name} cannot be parsed as Python, so it cannot be searched: correct or delete it.")
    return tree


def parse_python(source: str | bytes) -> ast.Module | None:
    """Parse Python source without running it; return None if it is not Python."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a student's "\d" must not cause a warning here
            return ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _refuse_unreadable(error: OSError) -> None:
    if isinstance(error, PermissionError):
        raise _unreadable(error)


def _unreadable(error: OSError) -> CheckFailed:
    return CheckFailed(f"{Path(error.filename).name} cannot be read: setup.py must not change permissions.")


def _too_large(name: str, limit: int) -> str:
    return f"{name} is larger than {limit // 1024} KiB, which is too large to search: make it smaller."
