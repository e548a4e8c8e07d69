"""Messages for students, shown without a traceback in a notebook or terminal."""

from __future__ import annotations

import html
from dataclasses import dataclass

STYLE = "border-left: 4px solid {colour}; padding: .4em .8em; margin: .4em 0"
INFO, TROUBLE = "#0072b2", "#d55e00"


@dataclass(frozen=True)
class Notice:
    """A sentence with optional lines of output, shown as a box in a notebook."""

    sentence: str
    detail: str = ""
    colour: str = INFO

    def __repr__(self) -> str:
        return "\n".join(part for part in (self.sentence, self.detail) if part)

    def _repr_html_(self) -> str:
        detail = f"<pre>{html.escape(self.detail)}</pre>" if self.detail else ""
        return f'<div style="{STYLE.format(colour=self.colour)}">{html.escape(self.sentence)}{detail}</div>'


class NotGraded(Notice):
    """The output of a locked grade cell in a student's notebook.

    Its text form is 0.0. nbgrader reads a cell's text as its points and gives full points if the text is not a number.
    With 0.0, its "Validate" button and a plain `nbgrader autograde` give no points.
    """

    def __repr__(self) -> str:
        return "0.0"
