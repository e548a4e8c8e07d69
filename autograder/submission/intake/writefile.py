"""The cells that only write a file: `%%writefile` with a path, and the file's text below it."""

from __future__ import annotations

import os
import re
from pathlib import PurePosixPath

_HEAD = re.compile(r"%%(?:write)?file[ \t]+(\"[^\"\n]+\"|'[^'\n]+'|[^\s'\"]+)[ \t]*\n")
_EXPANDED = frozenset("{}$~\\\0")  # characters that IPython expands, or that no file name can contain
MAX_NAME_BYTES = 200


def written_file(source: str) -> tuple[PurePosixPath, str] | None:
    """Return the path and the text that a cell writes, or None if it also does anything else.

    The path is relative to the notebook's folder and stays below it.
    """
    match = _HEAD.match(text := source.lstrip("\n"))
    if match is None:
        return None
    name, body = match[1].strip("'\""), text[match.end() :]
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts or not body or _EXPANDED.intersection(name) or name.startswith("-"):
        return None
    if len(os.fsencode(name.encode("utf-8", "replace").decode())) > MAX_NAME_BYTES:
        return None
    return path, body if body.endswith("\n") else body + "\n"


def same_text(one: str, two: str) -> bool:
    """Return whether two texts are equal except for line ends, a byte order mark and empty lines at the end."""
    return _plain(one) == _plain(two)


def _plain(text: str) -> str:
    return text.removeprefix("\ufeff").replace("\r\n", "\n").rstrip()
