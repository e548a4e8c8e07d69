"""Cleans, shortens and compares texts of students and programs, which may be very long and contain any character."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable
from itertools import islice

MAX_NAMES = 100  # how many names are compared with one word
MAX_NAME = 200  # characters; longer names are not compared

# Terminal sequences for colours, cursor moves and window titles (ECMA-48: CSI and OSC).
_TERMINAL = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?")
# Characters that XML 1.0 and HTML forbid, lone surrogates, and the bidirectional overrides that reorder a line.
_FORBIDDEN = re.compile("[^\t\n\x20-\x7e\xa0-\u2027\u202f-\u2065\u206a-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_LINE_ENDS = dict.fromkeys(map(ord, "\r\x85\u2028\u2029"), "\n")  # other line separators


def clean(text: str) -> str:
    """Remove terminal sequences from `text`, and replace each character that a page must not contain with U+FFFD."""
    text = _TERMINAL.sub("", text).replace("\r\n", "\n").translate(_LINE_ENDS)
    return _FORBIDDEN.sub("\ufffd", text)


def shorten(text: str, limit: int) -> str:
    """Return `text`. If it is longer than `limit` characters, cut it, and add a remark that gives the full length."""
    if len(text) <= limit:
        return text
    remark = f"… ({len(text):,} characters in all)"
    return text[: limit - len(remark)] + remark


def comparable(names: Iterable[str]) -> list[str]:
    """Return the first `MAX_NAMES` names that are short enough to compare.

    The time to compare two names grows with the product of their lengths, and a student may use many long names.
    """
    return list(islice((name for name in names if len(name) <= MAX_NAME), MAX_NAMES))


def nearest(word: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the name that is most similar to `word`, or an empty string if none is similar enough.

    Args:
        word: a name from the course.
        names: names from the student. Only those that `comparable` returns are compared.
        cutoff: the smallest ratio of `difflib.SequenceMatcher`, in [0, 1], that counts as similar enough.
    """
    return next(iter(difflib.get_close_matches(word, comparable(names), 1, cutoff)), "")


# Unicode categories: control characters, invisible marks and bidirectional overrides, surrogates, line separators.
_INVISIBLE = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


def visible(text: str, *, line: bool = False) -> str:
    r"""Return `text` for a terminal, with escapes such as `\x1b` for control and invisible characters.

    Newlines and tabs are escaped only if `line` is set, for example for a name, which must stay on one line.
    """
    if text.isprintable():
        return text
    allowed = "" if line else "\n\t"
    return "".join(char if char in allowed else _escape(char) for char in text.replace("\r\n", "\n"))


def _escape(char: str) -> str:
    return char.encode("unicode_escape").decode() if unicodedata.category(char) in _INVISIBLE else char
