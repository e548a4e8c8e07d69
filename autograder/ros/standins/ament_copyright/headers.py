"""The copyright notices and the licence of a file, read from the comment at its top."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

UNKNOWN = "<unknown>"

# Phrases of each licence, by Jazzy's identifiers. The more specific licences come first.
_PHRASES: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("Apache-2.0", ("licensed under the apache license, version 2.0", "apache license version 2.0, january 2004")),
    ("BSL-1.0", ("boost software license, version 1.0", "boost software license - version 1.0")),
    # The name of the LGPL alone is not enough, because the text of the GPL mentions it.
    (
        "LGPL-3.0-only",
        ("gnu lesser general public license version 3", "terms of the gnu lesser general public license"),
    ),
    ("GPL-3.0-only", ("gnu general public license",)),
    (
        "BSD-3-Clause",
        ("neither the name of", "redistribution and use in source and binary forms"),
    ),
    ("BSD-2-Clause", ("redistribution and use in source and binary forms",)),
    ("MIT", ("permission is hereby granted, free of charge", "the above copyright notice and this permission notice")),
    ("MIT-0", ("permission is hereby granted, free of charge",)),
)
# These licences require all their phrases; the others require one.
_ALL_PHRASES = {"BSD-3-Clause", "MIT"}

IDENTIFIERS = tuple(name for name, _ in _PHRASES)

_COPYRIGHT = re.compile(r"copyright\b[\s:]*(?:\(c\)|©)?\s*(\d{4}(?:\s*[-,]\s*\d{4})*)[,\s]\s*(\S.*)", re.IGNORECASE)
_SPDX = re.compile(r"SPDX-License-Identifier:\s*(\S+)", re.IGNORECASE)


@dataclass(frozen=True)
class Header:
    """The content of a file's first comment.

    Attributes:
        copyrights: the copyright notices, such as `2026 Ada Lovelace`.
        licence: the identifier of the licence, or `<unknown>`.
    """

    copyrights: tuple[str, ...]
    licence: str


def read_header(path: Path) -> Header:
    """Read the comment at the top of a source file (below a shebang or coding line).

    Raises:
        OSError, UnicodeDecodeError: the file cannot be read as UTF-8 text.
    """
    return parse_header(
        path.read_text(encoding="utf-8").splitlines(), comment="#" if _has_hash_comments(path) else "//"
    )


def parse_header(lines: Iterable[str], *, comment: str) -> Header:
    """Find copyright notices and the licence in the first block of comments of a file's lines."""
    block: list[str] = []
    in_block_comment = False
    for index, line in enumerate(lines):
        text = line.strip()
        if index < 2 and (text.startswith("#!") or re.match(r"#.*coding[:=]", text)):
            continue
        if not text and not block:
            continue
        if comment == "//" and (in_block_comment or text.startswith("/*")):
            in_block_comment = "*/" not in text
            block.append(text.strip("/* "))
        elif text.startswith(comment):
            block.append(text.lstrip(comment).strip())
        else:
            break
    notices = tuple(f"{m[1]} {m[2].rstrip('. ')}" for line in block if (m := _COPYRIGHT.search(line)))
    return Header(notices, _licence(" ".join(block)))


def _licence(text: str) -> str:
    spdx = _SPDX.search(text)
    if spdx and spdx[1] in IDENTIFIERS:
        return spdx[1]
    normalized = re.sub(r"\s+", " ", text).lower()
    for name, phrases in _PHRASES:
        matches = [phrase in normalized for phrase in phrases]
        if all(matches) if name in _ALL_PHRASES else any(matches):
            return name
    return UNKNOWN


def licence_of_text(text: str) -> str:
    """Return the identifier of a licence's full text, or `<unknown>`."""
    return _licence(text)


def _has_hash_comments(path: Path) -> bool:
    return path.suffix in {".py", ".cmake"} or path.name == "CMakeLists.txt"
