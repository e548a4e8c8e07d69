"""Text that a page can carry: what came out of a student's program may hold anything."""

from __future__ import annotations

import re

NOT_GRADED = "The grader itself failed. This is not a zero."
# Colours and cursor moves of a terminal: ECMA-48 control sequences, and operating system commands (window titles).
_TERMINAL = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?")
# Characters that XML 1.0 and HTML forbid, half surrogate pairs, and the bidirectional overrides that reorder a line.
_FORBIDDEN = re.compile("[^\t\n\x20-\x7e\x85\xa0-\u2029\u202f-\u2065\u206a-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def clean(text: str) -> str:
    """Return `text` without terminal sequences, with each character that no page may hold made visible as U+FFFD."""
    text = _TERMINAL.sub("", text).replace("\r\n", "\n").replace("\r", "\n")
    return _FORBIDDEN.sub("\ufffd", text)


def one_line(text: str) -> str:
    """Return `text` cleaned, its white space folded to single blanks."""
    return " ".join(clean(text).split())


def number(value: float) -> str:
    """Write points as people do: `3`, `2.5`, `0.33`."""
    return f"{round(value, 2):g}" if abs(value) < 1e5 else f"{value:.0f}"
