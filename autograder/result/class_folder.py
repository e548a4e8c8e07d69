"""The folder of a class's results: files about the class, and a folder for each student."""

from __future__ import annotations

import os

from autograder.result.model import UNFINISHED

SUMMARY = "index.html"  # the table of the class
EARLIER_MARKS = "earlier-marks.json"  # a list of results, which `autograder compare` can read
COLLECTION_REPORT = "handed_in.json"  # the late students, and the files that belong to no student
RESULT, RESULTS = "result.json", "results.json"  # one result, or a list of results
FILES = frozenset((SUMMARY, EARLIER_MARKS, COLLECTION_REPORT, RESULT, RESULTS))

MAX_NAME = 255  # bytes, the limit of Linux's file systems


def folder_name_problem(student: str) -> str:
    """Return a clause that says why a student's name cannot be a folder's name here, or an empty string if it can."""
    if student in FILES:
        return f"{student} is the name of a file beside the results: give it another name"
    if student in ("", ".", "..", UNFINISHED) or "/" in student or "\0" in student:
        return f"{student!r} cannot be the name of a folder: give it another name"
    if len(os.fsencode(student)) > MAX_NAME:
        return f"the name is longer than {MAX_NAME} bytes: give it a shorter one"
    return ""
