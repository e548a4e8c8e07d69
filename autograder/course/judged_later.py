"""Writes the titles of an assignment's hidden checks into the folder of its visible ones, for students to read.

`check(...)` lists them when all visible checks have passed. A title is a sentence of the contract; it tells no input.
"""

from __future__ import annotations

import json

from autograder.checks import suites
from autograder.layout import judged_later


def outdated() -> dict[str, str]:
    """Return the text that each assignment's file should have, by the assignment, where the file is out of date."""
    found = {}
    for assignment in sorted({*suites.checked()} & {*suites.graded()}):
        path, text = judged_later(assignment), _text(assignment)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            found[assignment] = text
    return found


def _text(assignment: str) -> str:
    shown = {check.title for check in suites.visible(assignment).checks}
    titles = [check.title for check in suites.hidden(assignment).checks if check.title not in shown]
    return json.dumps(titles, indent=1, ensure_ascii=False) + "\n"
