"""What programs wrote while a robot drove: lines with their times, a bounded number of them."""

from __future__ import annotations

from collections import deque

Line = tuple[float, str]
"""Seconds since the start of the run, and what was written then."""

MAX_LINES = 1000  # at the start of a run, and as many at its end
MAX_CHARACTERS = 300  # in a line
LEFT_OUT = "(lines are left out here)"


class Log:
    """Collects lines. Of a flood it keeps the first and the last ones."""

    def __init__(self) -> None:
        self._first: list[Line] = []
        self._last: deque[Line] = deque(maxlen=MAX_LINES + 1)

    def add(self, seconds: float, text: str) -> None:
        """Add a line, whose end is cut off if it is too long. An empty one is not kept."""
        if text.strip():
            line = (round(seconds, 3), text if len(text) <= MAX_CHARACTERS else text[: MAX_CHARACTERS - 1] + "…")
            (self._first if len(self._first) < MAX_LINES else self._last).append(line)

    def lines(self) -> tuple[Line, ...]:
        """Return what was kept, in the order of its times."""
        return shorten((*self._first, *self._last), 2 * MAX_LINES)


def shorten(lines: tuple[Line, ...], most: int) -> tuple[Line, ...]:
    """Return the first and the last `most / 2` lines, with a word between them if there are more."""
    if len(lines) <= most:
        return lines
    last = lines[len(lines) - most // 2 :]
    return (*lines[: most // 2], (last[0][0], LEFT_OUT), *last) if last else ()
