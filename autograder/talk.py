"""What the grader asked a student's nodes during a check, and what they answered, in time, for the feedback."""

from __future__ import annotations

from dataclasses import dataclass, field

from autograder.plain_text import clean

MAX_ROWS = 20  # at the start of a check, and as many at its end
MAX_CHARACTERS = 300  # in a row


@dataclass(frozen=True)
class Row:
    """A request, or what came back."""

    seconds: float  # of ROS time since the program started
    what: str  # "asked", "answered", "feedback" or "no answer"
    name: str  # of the service or topic
    text: str  # of the message


@dataclass
class Talk:
    """The rows of the running check. Its workspace carries it to the harnesses; the grading takes them."""

    _rows: list[Row] = field(default_factory=list)

    def add(self, seconds: float, what: str, name: str, text: str) -> None:
        """Add a row. Of too many, the first and the last are kept."""
        text = clean(text)
        shown = text if len(text) <= MAX_CHARACTERS else text[: MAX_CHARACTERS - 1] + "…"
        self._rows.append(Row(round(seconds, 3), what, name[:MAX_CHARACTERS], shown))
        if len(self._rows) > 2 * MAX_ROWS:
            del self._rows[MAX_ROWS]

    def take(self) -> tuple[Row, ...]:
        """Return the rows, and forget them."""
        rows, self._rows = tuple(self._rows), []
        return rows
