"""The requests of the grader to a student's nodes during a check, and their responses, for the feedback."""

from __future__ import annotations

from dataclasses import dataclass, field

from autograder.plain_text import clean

MAX_ROWS = 20  # at the start of a check, and as many at its end
MAX_CHARACTERS = 300  # of a name or text


@dataclass(frozen=True)
class Exchange:
    """A request, a response, a feedback message, or no answer."""

    seconds: float  # of ROS time since the program started
    what: str  # "asked", "answered", "feedback" or "no answer"
    name: str  # of the service or topic
    text: str  # of the message


@dataclass
class ExchangeLog:
    """The exchanges of the running check. A workspace shares it with its harnesses, and the grader reads it."""

    _rows: list[Exchange] = field(default_factory=list)

    def add(self, seconds: float, what: str, name: str, text: str) -> None:
        """Add an exchange. Of too many, the first and the last are kept."""
        text = clean(text)
        shown = text if len(text) <= MAX_CHARACTERS else text[: MAX_CHARACTERS - 1] + "…"
        self._rows.append(Exchange(round(seconds, 3), what, name[:MAX_CHARACTERS], shown))
        if len(self._rows) > 2 * MAX_ROWS:
            del self._rows[MAX_ROWS]

    def take(self) -> tuple[Exchange, ...]:
        """Return the exchanges, and forget them."""
        rows, self._rows = tuple(self._rows), []
        return rows
