"""The export formats. Each module in this folder is a format of the same name.

Its `FOLDER` is True if the format is written to a folder, and False if it is written to a single file. Its
`write(results, out)` writes results to the file or folder `out`, and returns the file to open first.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from autograder.exceptions import UsageError
from autograder.result.model import Result

FORMATS: Mapping[str, ModuleType] = {
    module.name: import_module(f"{__name__}.{module.name}") for module in pkgutil.iter_modules(__path__)
}


def write(results: Sequence[Result], name: str, out: Path, **options: Any) -> Path:
    """Write results in a format and return the file to open first.

    Args:
        results: from `load`.
        name: name of the format, a key of `FORMATS`.
        out: the file or folder to write.
        options: further arguments of the format's own function.

    Raises:
        UsageError: `out` is a folder instead of a file or vice versa, or two results need the same file.
    """
    format = FORMATS[name]
    if out.exists() and out.is_dir() is not format.FOLDER:
        kind = "folder" if format.FOLDER else "file"
        raise UsageError(f"{out}: {name} is written to a {kind}; give the path of a {kind}")
    out.parent.mkdir(parents=True, exist_ok=True)
    first: Path = format.write(results, out, **options)
    return first
