"""Whether the files that came with a package are as they were given."""

from __future__ import annotations

from collections.abc import Collection, Mapping


def changed_files(kept: Mapping[str, bytes], given: Mapping[str, bytes], folders: Collection[str]) -> list[str]:
    """Return the given files, below these folders of a package, that are missing or changed; white space is free.

    Args:
        kept: the student's files, by their paths below the package's folder.
        given: the files as they were given, by the same paths.
        folders: names of folders of the package.
    """
    mine = [name for name in given if name.partition("/")[0] in folders]
    return [name for name in mine if kept.get(name, b"").split() != given[name].split()]
