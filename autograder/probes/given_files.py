"""Finds files that came with a package and that the student has changed or deleted."""

from __future__ import annotations

from collections.abc import Collection, Mapping


def changed_files(actual: Mapping[str, bytes], given: Mapping[str, bytes], folders: Collection[str]) -> list[str]:
    """Return the given files, below these folders of a package, that are missing or changed.

    White space does not count, and neither does the copyright comment at the start: a cell of a notebook gives a file
    without it.

    Args:
        actual: the student's files, by their paths below the package's folder.
        given: the files as they were given, by the same paths.
        folders: names of folders of the package.
    """
    names = [name for name in given if name.partition("/")[0] in folders]
    return [name for name in names if not _is_as_given(actual.get(name, b""), given[name])]


def strip_licence(text: str) -> str:
    """Return Python source without the copyright comment at its start."""
    lines = text.splitlines(keepends=True)
    if not (lines and lines[0].startswith("# Copyright")):
        return text
    body = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    return "".join(lines[body:]).lstrip("\n")


def _is_as_given(actual: bytes, given: bytes) -> bool:
    unlicensed = strip_licence(given.decode(errors="surrogateescape")).encode(errors="surrogateescape")
    return actual.split() in (given.split(), unlicensed.split())
