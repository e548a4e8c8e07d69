"""Cleans text for pages, because the output of a student's program may hold any character."""

from __future__ import annotations

import re

# Terminal sequences for colours, cursor moves and window titles (ECMA-48: CSI and OSC).
_TERMINAL = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?")
# Characters that XML 1.0 and HTML forbid, half surrogate pairs, and the bidirectional overrides that reorder a line.
_FORBIDDEN = re.compile("[^\t\n\x20-\x7e\x85\xa0-\u2029\u202f-\u2065\u206a-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def clean(text: str) -> str:
    """Return `text` without terminal sequences. Each character that a page may not hold is replaced by U+FFFD."""
    text = _TERMINAL.sub("", text).replace("\r\n", "\n").replace("\r", "\n")
    return _FORBIDDEN.sub("\ufffd", text)
