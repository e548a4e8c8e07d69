"""Finds hidden text in the files that students get, even if it is reversed, encoded or split into pieces.

Hidden text is a word that was planted in a version of a package (`leak_markers`), or a line that occurs only in the
hidden checks.
"""

from __future__ import annotations

import base64
import codecs
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from urllib.parse import unquote

from PIL import Image

from autograder.probes.leak_markers import markers_in

STOLEN = "STOLEN /"  # an attack's payload prints this before a path that it could read or write
TEXTS = (".json", ".html", ".ipynb", ".svg", ".csv", ".txt")
PICTURES = (".png",)
_HEX = re.compile(r"(?:[0-9a-fA-F]{2}[ :,-]?){20,}")
_BASE64 = re.compile(r"[A-Za-z0-9+/_-]{24,}")
_ID = re.compile(r"\[([^\[\]]{1,8})\]")  # the id of a parametrized test
_NUMBER = re.compile(r"\b\d{2,3}\b")


def hidden_text_in(text: str, lines: Iterable[str] = ()) -> list[str]:
    """Return the planted words and hidden lines that a text contains, in their original form.

    Args:
        text: text that a student gets.
        lines: lines that occur only in hidden files.
    """
    readings = list(_readings(text))
    words = {word for reading in readings for word in markers_in(reading.lower())}
    squeezed = {line: _squeezed(line) for line in lines}
    words |= {line for line, short in squeezed.items() if any(line in read or short in read for read in readings)}
    return sorted(words)


def texts_of(folder: Path) -> Iterator[str]:
    """Yield the names and texts of all files from a grading and its feedback, including the metadata of pictures."""
    for path in sorted(folder.rglob("*")):
        yield path.name
        if path.suffix in TEXTS:
            yield path.read_text(encoding="utf-8", errors="replace")
        elif path.suffix in PICTURES:
            with Image.open(path) as picture:
                yield from (f"{name} {value}" for name, value in picture.info.items())


def _readings(text: str) -> Iterator[str]:
    """Yield every decoding of a text."""
    for plain in (text, text[::-1]):
        yield plain
        yield _squeezed(plain)
        yield codecs.encode(plain, "rot13")
        yield _squeezed(codecs.encode(plain, "rot13"))
    yield unquote(text)
    yield text.encode("latin-1", "backslashreplace").decode("unicode_escape", "replace")
    yield "".join(_ID.findall(text))
    yield "".join(chr(int(number)) for number in _NUMBER.findall(text))
    for decode in (_from_hex, _from_base64):
        for part in decode(text):
            yield part
            yield part[::-1]


def _squeezed(text: str) -> str:
    """Return only the letters, in lower case, so that separators cannot hide a word."""
    return "".join(char for char in text.lower() if char.isalpha())


def _from_hex(text: str) -> Iterator[str]:
    for match in _HEX.finditer(text):
        digits = re.sub(r"[^0-9a-fA-F]", "", match[0])
        yield from (bytes.fromhex(_even(digits[start:])).decode("latin-1") for start in (0, 1))


def _from_base64(text: str) -> Iterator[str]:
    for match in _BASE64.finditer(text):
        run = match[0].replace("-", "+").replace("_", "/")
        for start in range(4):
            part = run[start:]
            part = part[:-1] if len(part) % 4 == 1 else part  # a single character does not encode a byte
            yield base64.b64decode(part + "=" * (-len(part) % 4)).decode("latin-1")


def _even(digits: str) -> str:
    return digits[: len(digits) // 2 * 2]


ENCODINGS: dict[str, Callable[[str], str]] = {  # that `hidden_text_in` decodes; used by its tests and by attacks
    "plain": str,
    "reversed": lambda text: text[::-1],
    "upper case": str.upper,
    "rot13": lambda text: codecs.encode(text, "rot13"),
    "hex": lambda text: text.encode().hex(),
    "hex with an odd beginning": lambda text: "a" + text.encode().hex(" "),
    "base64": lambda text: base64.b64encode(text.encode()).decode(),
    "base64, one on": lambda text: base64.b64encode(b"x" + text.encode()).decode(),
    "base64, two on": lambda text: base64.urlsafe_b64encode(b"xy" + text.encode()).decode(),
    "base64 in a word": lambda text: "abc" + base64.b64encode(text.encode()).decode(),
    "per cent": lambda text: "".join(f"%{ord(char):02x}" for char in text),
    "escapes": lambda text: "".join(f"\\x{ord(char):02x}" for char in text),
    "dots between": lambda text: ".".join(text),
    "lines between": lambda text: "\n".join(text),
    "one test each": lambda text: " ".join(f"test_a[{char}]" for char in text),
    "numbers": lambda text: " ".join(str(ord(char)) for char in text),
}
