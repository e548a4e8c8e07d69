"""Records the grader's requests to a student's nodes during a check, and the responses, for the feedback."""

from __future__ import annotations

from dataclasses import dataclass, field

from autograder.plain_text import clean

MAX_ROWS = 20  # how many exchanges are kept from the start of a check, and as many from its end
MAX_CHARACTERS = 300  # characters of a name or text


@dataclass(frozen=True)
class Exchange:
    """A request, a response, a feedback message, or the lack of an answer."""

    seconds: float  # ROS time since the program started
    what: str  # "asked", "answered", "feedback" or "no answer"
    name: str  # name of the service or topic
    text: str  # text of the message


@dataclass
class ExchangeLog:
    """The exchanges of the running check. A workspace shares the log with its harnesses, and the grader reads it."""

    _rows: list[Exchange] = field(default_factory=list)

    def add(self, seconds: float, what: str, name: str, text: str) -> None:
        """Add an exchange. If there are too many, only the first and the last ones are kept."""
        text = clean(text)
        short_text = text if len(text) <= MAX_CHARACTERS else text[: MAX_CHARACTERS - 1] + "…"
        self._rows.append(Exchange(round(seconds, 3), what, name[:MAX_CHARACTERS], short_text))
        if len(self._rows) > 2 * MAX_ROWS:
            del self._rows[MAX_ROWS]

    def take(self) -> tuple[Exchange, ...]:
        """Return the exchanges, and clear the log."""
        rows, self._rows = tuple(self._rows), []
        return rows
