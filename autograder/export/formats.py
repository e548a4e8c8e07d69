"""The formats by name, and writing one of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.export import gradescope, html, junit, markdown, table
from autograder.export.stored import Stored

Writer = Callable[[Sequence[Stored], Path], Path]

FORMATS: dict[str, Writer] = {
    "csv": table.write,
    "gradescope": gradescope.write,
    "html": html.write,
    "junit": junit.write,
    "markdown": markdown.write,
}


def write(stored: Sequence[Stored], format: str, out: Path) -> Path:
    """Write results in a format and return the file to open first.

    Args:
        stored: what `load` read.
        format: a key of `FORMATS`.
        out: the file to write (csv, junit, markdown) or the folder (html, gradescope).

    Raises:
        UsageError: the format is not known, `out` is of the other kind, or two results would share a file.
    """
    if format not in FORMATS:
        raise UsageError(f"there is no format {format!r}; the formats are {', '.join(sorted(FORMATS))}")
    wants_folder = format in ("html", "gradescope")
    if out.exists() and out.is_dir() is not wants_folder:
        raise UsageError(f"{out}: {format} is written to a {'folder' if wants_folder else 'file'}, and this is none")
    return FORMATS[format](stored, out)
