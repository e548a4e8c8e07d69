"""Cleans text for pages and for terminals, because the output of a student's program may hold any character."""

from __future__ import annotations

import re
import unicodedata

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
