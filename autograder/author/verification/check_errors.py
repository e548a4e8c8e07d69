"""Finds the errors in the log of a grading that a course's own checks raised."""

from __future__ import annotations

import re
from pathlib import Path

from autograder.author.course.findings import display_path

TRACEBACK = "Traceback (most recent call last):\n"
_FRAME = re.compile(r'^  File "(.+)", line (\d+), in ', re.MULTILINE)


def errors_in_checks(log: str, folder: Path) -> list[str]:
    """Return each error in a log once, as FILE:LINE: ERROR. FILE is the innermost file of its traceback in `folder`."""
    errors: dict[str, None] = {}
    for traceback in log.split(TRACEBACK)[1:]:
        frames = [(Path(file), line) for file, line in _FRAME.findall(traceback) if Path(file).is_relative_to(folder)]
        error = next((line for line in traceback.splitlines() if line and not line.startswith(" ")), "")
        if frames and error:
            file, line = frames[-1]
            errors.setdefault(f"{display_path(file)}:{line}: {error}")
    return list(errors)
