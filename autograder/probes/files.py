"""Reads files that untrusted code may have written: plain files of a bounded size, and no links."""

from __future__ import annotations

import ast
import os
import stat
import warnings
from collections.abc import Collection
from pathlib import Path


def read_plain(path: Path, limit: int) -> bytes | None:
    """Return a plain file's bytes, or None for a link, a pipe, a folder or a file of more than `limit` bytes."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        return None
    with os.fdopen(descriptor, "rb") as stream:
        data = stream.read(limit + 1)
    return data if len(data) <= limit else None


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
        skip: names of folders that are not searched.
        suffix: the suffix of the files' names.
    """
    files: list[Path] = []
    for parent, folders, names in os.walk(folder) if not folder.is_symlink() else ():
        folders[:] = sorted(name for name in folders if name not in skip)
        paths = [Path(parent, name) for name in sorted(names) if name.endswith(suffix)]
        files += [path.relative_to(folder) for path in paths if stat.S_ISREG(path.lstat().st_mode)]
        if len(files) >= limit:
            break
    return files[:limit]


def parse_python(source: str | bytes) -> ast.Module | None:
    """Parse Python source without running it; return None if it is not Python."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a student's "\d" must not cause a warning here
            return ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
