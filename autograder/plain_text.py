"""Cleans, shortens and compares text of students and their programs, which may hold any character and be very long."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable
from itertools import islice

MAX_NAMES = 100  # that are compared with one word
MAX_NAME = 200  # characters of a name that is compared

# Terminal sequences for colours, cursor moves and window titles (ECMA-48: CSI and OSC).
_TERMINAL = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?")
# Characters that XML 1.0 and HTML forbid, half surrogate pairs, and the bidirectional overrides that reorder a line.
_FORBIDDEN = re.compile("[^\t\n\x20-\x7e\xa0-\u2027\u202f-\u2065\u206a-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ENDS = dict.fromkeys(map(ord, "\r\x85\u2028\u2029"), "\n")  # other ends of lines


def clean(text: str) -> str:
    """Return `text` without terminal sequences. Each character that a page may not hold is replaced by U+FFFD."""
    text = _TERMINAL.sub("", text).replace("\r\n", "\n").translate(_ENDS)
    return _FORBIDDEN.sub("\ufffd", text)


def shorten(text: str, most: int) -> str:
    """Return `text`, or as much of it as fits into `most` characters with a remark that says how much is left out."""
    if len(text) <= most:
        return text
    remark = f"… ({len(text):,} characters in all)"
    return text[: most - len(remark)] + remark


def comparable(names: Iterable[str]) -> list[str]:
    """Return those names, at most `MAX_NAMES`, that are short enough to compare.

    To compare two names takes the product of their lengths, and a student's may be many and long.
    """
    return list(islice((name for name in names if len(name) <= MAX_NAME), MAX_NAMES))


def nearest(word: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the name that `word` is probably a misspelling of, or the reverse; the empty string if there is none.

    Args:
        word: a text of the course's.
        names: any number of them; of a student's, the first `MAX_NAMES` short ones are compared.
        cutoff: the ratio of `difflib.SequenceMatcher` that the name has to have, in [0, 1].
    """
    return next(iter(difflib.get_close_matches(word, comparable(names), 1, cutoff)), "")


# Controls of both sets, marks that are not seen or turn a line round, half surrogate pairs, and other ends of lines.
_UNSEEN = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


def visible(text: str, *, line: bool = False) -> str:
    r"""Return `text` for a terminal, with control and invisible characters as escapes such as `\x1b`.

    Newlines and tabs stay as they are, unless the text is a `line`, such as a name.
    """
    if text.isprintable():
        return text
    kept = "" if line else "\n\t"
    return "".join(char if char in kept else _visible(char) for char in text.replace("\r\n", "\n"))


def _visible(char: str) -> str:
    return char.encode("unicode_escape").decode() if unicodedata.category(char) in _UNSEEN else char
