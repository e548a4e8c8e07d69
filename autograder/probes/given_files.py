"""Whether the files that came with a package are as they were given."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from autograder.probes.files import read_plain

MAX_BYTES = 256 * 1024


def changed_files(source: Path, given: Path, folders: Collection[str]) -> list[str]:
    """Return the given files, below these folders of a package, that are missing or changed; white space is free.

    Args:
        source: the student's package.
        given: the package with the files as they were given.
        folders: names of folders of the package.
    """
    files = [path for path in sorted(given.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]
    names = [path.relative_to(given) for path in files]
    return [
        str(name)
        for name in names
        if name.parts[0] in folders
        and (read_plain(source / name, MAX_BYTES) or b"").split() != (given / name).read_bytes().split()
    ]
