"""Whose a file is and under which licence, read from the comment at its top."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

UNKNOWN = "<unknown>"

# A phrase that only this licence's header or text has; the more particular ones come first. Jazzy's identifiers.
_PHRASES: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("Apache-2.0", ("licensed under the apache license, version 2.0", "apache license version 2.0, january 2004")),
    ("BSL-1.0", ("boost software license, version 1.0", "boost software license - version 1.0")),
    # The GPL's text ends with a word on the LGPL, so the name alone will not do.
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
# For these every phrase has to be there; for the others one is enough.
_ALL_PHRASES = {"BSD-3-Clause", "MIT"}

IDENTIFIERS = tuple(name for name, _ in _PHRASES)

_COPYRIGHT = re.compile(r"copyright\b[\s:]*(?:\(c\)|©)?\s*(\d{4}(?:\s*[-,]\s*\d{4})*)[,\s]\s*(\S.*)", re.IGNORECASE)
_SPDX = re.compile(r"SPDX-License-Identifier:\s*(\S+)", re.IGNORECASE)


@dataclass(frozen=True)
class Header:
    """What a file's first comment says.

    Attributes:
        copyrights: each notice, as `2026 Ada Lovelace`.
        licence: the licence's identifier, or `<unknown>`.
    """

    copyrights: tuple[str, ...]
    licence: str


def read_header(path: Path) -> Header:
    """Read the comment at the top of a source file (below a shebang or coding line).

    Raises:
        OSError, UnicodeDecodeError: the file cannot be read as UTF-8 text.
    """
    return parse_header(path.read_text(encoding="utf-8").splitlines(), comment="#" if _hash(path) else "//")


def parse_header(lines: Iterable[str], *, comment: str) -> Header:
    """Find copyright notices and the licence in the first block of comments of a file's lines."""
    block: list[str] = []
    in_block_comment = False
    for number, line in enumerate(lines):
        text = line.strip()
        if number < 2 and (text.startswith("#!") or re.match(r"#.*coding[:=]", text)):
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
    plain = re.sub(r"\s+", " ", text).lower()
    for name, phrases in _PHRASES:
        found = [phrase in plain for phrase in phrases]
        if all(found) if name in _ALL_PHRASES else any(found):
            return name
    return UNKNOWN


def licence_of_text(text: str) -> str:
    """Return the identifier of a licence's full text, or `<unknown>`."""
    return _licence(text)


def _hash(path: Path) -> bool:
    return path.suffix in {".py", ".cmake"} or path.name == "CMakeLists.txt"
