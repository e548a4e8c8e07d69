"""Finds hidden text in the files that students get, even if it is reversed, encoded or split into pieces.

Hidden text is a word that was planted in a version of a package (`leak_markers`), or a line that occurs only in the
hidden checks.
"""

from __future__ import annotations

import base64
import codecs
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from urllib.parse import unquote

from PIL import Image

from autograder.probes.leak_markers import markers_in

STOLEN = "STOLEN /"  # an attack's payload prints this before each path that it could read or write
TEXTS = (".json", ".html", ".ipynb", ".svg", ".csv", ".txt")  # the suffixes of files that contain text
IMAGES = (".png",)  # the suffixes of image files, whose metadata may contain text
_HEX = re.compile(r"(?:[0-9a-fA-F]{2}[ :,-]?){20,}")
_BASE64 = re.compile(r"[A-Za-z0-9+/_-]{24,}")
_ID = re.compile(r"\[([^\[\]]{1,8})\]")  # the id of a parametrized test case
_NUMBER = re.compile(r"\b\d{2,3}\b")


def hidden_text_in(text: str, lines: Iterable[str] = ()) -> list[str]:
    """Return the planted words and hidden lines that a text contains, in their original form.

    Args:
        text: text that a student gets.
        lines: lines that occur only in hidden files.
    """
    decodings = list(_decodings(text))
    leaked_texts = {word for decoding in decodings for word in markers_in(decoding.lower())}
    letters_of = {line: _letters(line) for line in lines}
    for line, letters in letters_of.items():
        if any(line in decoding or letters in decoding for decoding in decodings):
            leaked_texts.add(line)
    return sorted(leaked_texts)


def texts_of(folder: Path) -> Iterator[str]:
    """Yield the names and texts of all files in a folder with a result and its feedback, and the pictures' metadata."""
    for path in sorted(folder.rglob("*")):
        yield path.name
        if path.suffix in TEXTS:
            yield path.read_text(encoding="utf-8", errors="replace")
        elif path.suffix in IMAGES:
            with Image.open(path) as picture:
                yield from (f"{name} {value}" for name, value in picture.info.items())


def _decodings(text: str) -> Iterator[str]:
    """Yield every decoding of a text."""
    for plain in (text, text[::-1]):
        yield plain
        yield _letters(plain)
        yield codecs.encode(plain, "rot13")
        yield _letters(codecs.encode(plain, "rot13"))
    yield unquote(text)
    yield text.encode("latin-1", "backslashreplace").decode("unicode_escape", "replace")
    yield "".join(_ID.findall(text))
    yield "".join(chr(int(number)) for number in _NUMBER.findall(text))
    for decode in (_from_hex, _from_base64):
        for part in decode(text):
            yield part
            yield part[::-1]


def _letters(text: str) -> str:
    """Return only the letters of a text, in lower case, because separators may hide a word."""
    return "".join(char for char in text.lower() if char.isalpha())


def _from_hex(text: str) -> Iterator[str]:
    for match in _HEX.finditer(text):
        digits = re.sub(r"[^0-9a-fA-F]", "", match[0])
        for start in (0, 1):
            end = start + (len(digits) - start) // 2 * 2
            yield bytes.fromhex(digits[start:end]).decode("latin-1")


def _from_base64(text: str) -> Iterator[str]:
    for match in _BASE64.finditer(text):
        digits = match[0].replace("-", "+").replace("_", "/")
        for start in range(4):
            part = digits[start:]
            part = part[:-1] if len(part) % 4 == 1 else part  # a single character does not encode a byte
            yield base64.b64decode(part + "=" * (-len(part) % 4)).decode("latin-1")
