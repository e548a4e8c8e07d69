"""Sentences for a student, shown plainly in a notebook and on a terminal."""

from __future__ import annotations

import html
from dataclasses import dataclass

STYLE = "border-left: 4px solid {colour}; padding: .4em .8em; margin: .4em 0"
INFO, TROUBLE = "#0072b2", "#d55e00"


@dataclass(frozen=True)
class Notice:
    """A sentence, and lines of output that belong to it; a calm box in a notebook, no traceback."""

    sentence: str
    detail: str = ""
    colour: str = INFO

    def __repr__(self) -> str:
        return "\n".join(part for part in (self.sentence, self.detail) if part)

    def _repr_html_(self) -> str:
        detail = f"<pre>{html.escape(self.detail)}</pre>" if self.detail else ""
        return f'<div style="{STYLE.format(colour=self.colour)}">{html.escape(self.sentence)}{detail}</div>'


class NotGraded(Notice):
    """What a locked grade cell says outside of grading.

    Its text form is 0.0. nbgrader takes a cell's text for its points, and gives full points to a text that is no
    number: so its "Validate" button and a plain `nbgrader autograde` give no credit.
    """

    def __repr__(self) -> str:
        return "0.0"
