"""Writes the titles of an assignment's hidden checks into the folder of its visible ones, for students to read.

`check(...)` lists them when all visible checks have passed. A title is a sentence of the contract; it tells no input.
"""

from __future__ import annotations

import json
from pathlib import Path

from autograder.checks import suites
from autograder.layout import judged_later


def texts() -> dict[Path, str]:
    """Return the text of each assignment's file."""
    return {judged_later(name): _text(name) for name in sorted({*suites.checked()} & {*suites.graded()})}


def _text(assignment: str) -> str:
    shown = {check.title for check in suites.visible(assignment).checks}
    titles = [check.title for check in suites.hidden(assignment).checks if check.title not in shown]
    return json.dumps(titles, indent=1, ensure_ascii=False) + "\n"
