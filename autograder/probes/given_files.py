"""Finds files that came with a package and that the student has changed or deleted."""

from __future__ import annotations

from collections.abc import Collection, Mapping


def changed_files(actual: Mapping[str, bytes], given: Mapping[str, bytes], folders: Collection[str]) -> list[str]:
    """Return the given files in some of a package's folders that the student has changed or deleted.

    Changes in whitespace do not count, nor does the removal of the copyright comment at the start, because the cells of
    a notebook write files without it.

    Args:
        actual: the student's files, by their paths below the package's folder.
        given: the original files, by the same paths.
        folders: the names of the folders, directly below the package's folder.
    """
    names = [name for name in given if name.partition("/")[0] in folders]
    return [name for name in names if not _is_unchanged(actual.get(name, b""), given[name])]


def strip_licence(text: str) -> str:
    """Return Python source without the copyright comment at its start."""
    lines = text.splitlines(keepends=True)
    if not (lines and lines[0].startswith("# Copyright")):
        return text
    body = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    return "".join(lines[body:]).lstrip("\n")


def _is_unchanged(actual: bytes, given: bytes) -> bool:
    without_licence = strip_licence(given.decode(errors="surrogateescape")).encode(errors="surrogateescape")
    return actual.split() in (given.split(), without_licence.split())
