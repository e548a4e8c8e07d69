"""Writes the files of a result. A new result replaces an old one only when it is complete."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from autograder.grade.job import Job
from autograder.plain_text import visible
from autograder.result.model import UNFINISHED, Result, write_json

RESULT = "result.json"
NOTEBOOK = "notebook.ipynb"
LOG = "grader.log"


def write_result(job: Job, result: Result, files: Mapping[str, bytes]) -> Result:
    """Write the result of a job and its `files`, and return the result as written, with the name of the student.

    Until all files are written, the folder contains the old result, even if the process is killed. `result.json` is
    replaced last, so the mark changes in one step. Files of the old result that the new one does not have are removed.
    """
    out = job.out
    result = replace(result, student=job.student, folder=out)
    remove_unfinished(out)
    folder = out / UNFINISHED
    folder.mkdir(parents=True)
    try:
        for name in files.keys() - {RESULT}:
            (folder / name).write_bytes(_escape_log(files[name]) if name == LOG else files[name])
        write_json(folder / RESULT, result.to_json())
        _replace(folder, out)
    finally:
        remove_unfinished(out)
    return result


def _escape_log(log: bytes) -> bytes:
    """Escape the control characters of a log, which quotes students' texts and which instructors read in a terminal."""
    return visible(log.decode("utf-8", "replace")).encode("utf-8", "backslashreplace")


def remove_unfinished(out: Path) -> None:
    """Remove files that a killed process left in the folder of a result."""
    shutil.rmtree(out / UNFINISHED, ignore_errors=True)


def _replace(folder: Path, out: Path) -> None:
    new_names = {path.name for path in folder.iterdir()}
    for name in sorted(new_names - {RESULT}):
        (folder / name).replace(out / name)
    obsolete = {NOTEBOOK, LOG, *_artifacts(out / RESULT)} - new_names
    for path in out.iterdir():
        if path.name in obsolete:
            path.unlink()
    (folder / RESULT).replace(out / RESULT)


def _artifacts(result: Path) -> set[str]:
    """Return the names of the pictures and runs of a stored result, or an empty set if it cannot be read."""
    if not result.is_file():
        return set()
    try:
        data = json.loads(result.read_text(encoding="utf-8"))
        return {artifact[key] for artifact in data["artifacts"] for key in ("name", "run")}
    except (OSError, ValueError, KeyError, TypeError):
        return set()
