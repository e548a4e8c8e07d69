"""The formats, a module each. A module added to this folder is a format under its own name.

Such a module has FOLDER, whether the format is written to a folder or to one file, and
`write(stored: Sequence[Stored], out: Path) -> Path`, which writes it and returns the file to open first.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Protocol, cast

from autograder.exceptions import UsageError
from autograder.export.stored import Stored


class Format(Protocol):
    """What a format's module holds."""

    FOLDER: bool

    def write(self, stored: Sequence[Stored], out: Path) -> Path:
        """Write results to the file or folder `out` and return the file to open first."""


FORMATS: Mapping[str, Format] = {
    found.name: cast(Format, import_module(f"{__name__}.{found.name}")) for found in pkgutil.iter_modules(__path__)
}


def write(stored: Sequence[Stored], name: str, out: Path) -> Path:
    """Write results in a format and return the file to open first.

    Args:
        stored: what `load` read.
        name: a key of `FORMATS`.
        out: the file to write, or the folder where the format is written to one.

    Raises:
        UsageError: the format is not known, `out` is of the other kind, or two results would share a file.
    """
    if name not in FORMATS:
        raise UsageError(f"there is no format {name!r}; the formats are {', '.join(FORMATS)}")
    format = FORMATS[name]
    if out.exists() and out.is_dir() is not format.FOLDER:
        raise UsageError(f"{out}: {name} is written to a {'folder' if format.FOLDER else 'file'}, and this is none")
    return format.write(stored, out)
