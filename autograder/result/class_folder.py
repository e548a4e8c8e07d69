"""The folder of a class's results: its own files, and beside them a folder for each student."""

from __future__ import annotations

import os

from autograder.result.model import UNFINISHED

SUMMARY = "index.html"  # the table of the class
EARLIER_MARKS = "earlier-marks.json"  # a list of results; `autograder compare` reads it, too
COLLECTION_REPORT = "handed_in.json"  # the late students, and the files that belong to no student
ONE, MANY = "result.json", "results.json"  # a result, and a list of them, which are looked for by these names
FILES = frozenset((SUMMARY, EARLIER_MARKS, COLLECTION_REPORT, ONE, MANY))

MAX_NAME = 255  # bytes, of Linux's file systems


def why_not_a_folder(student: str) -> str:
    """Return why the name of a student cannot be that of a folder here, as the end of a sentence; empty if it can."""
    if student in FILES:
        return f"{student} is the name of a file beside the results: give it another name"
    if student in ("", ".", "..", UNFINISHED) or "/" in student or "\0" in student:
        return f"{student!r} cannot be the name of a folder: give it another name"
    if len(os.fsencode(student)) > MAX_NAME:
        return f"the name is longer than {MAX_NAME} bytes: give it a shorter one"
    return ""
