"""The output of programs during a run: a limited number of lines with their times."""

from __future__ import annotations

from collections import deque

Line = tuple[float, str]
"""The time in seconds since the start of the run, and the text."""

MAX_LINES = 1000  # kept from the start of a run, and as many from its end
MAX_CHARACTERS = 300  # in a line; longer ones are truncated
OMISSION = "(lines are left out here)"


class Log:
    """Collects lines. If there are too many, it keeps the first and the last."""

    def __init__(self) -> None:
        self._first: list[Line] = []
        self._last: deque[Line] = deque(maxlen=MAX_LINES + 1)

    def add(self, seconds: float, text: str) -> None:
        """Add a line, truncated if it is too long. An empty line is ignored."""
        if text.strip():
            line = (round(seconds, 3), text if len(text) <= MAX_CHARACTERS else text[: MAX_CHARACTERS - 1] + "…")
            (self._first if len(self._first) < MAX_LINES else self._last).append(line)

    def lines(self) -> tuple[Line, ...]:
        """Return the collected lines, in the order of their times."""
        return shorten((*self._first, *self._last), 2 * MAX_LINES)


def shorten(lines: tuple[Line, ...], limit: int) -> tuple[Line, ...]:
    """Return at most `limit` lines: if there are more, the first and the last, with `OMISSION` between them."""
    if len(lines) <= limit:
        return lines
    last = lines[len(lines) - limit // 2 :]
    return (*lines[: limit // 2], (last[0][0], OMISSION), *last) if last else ()
