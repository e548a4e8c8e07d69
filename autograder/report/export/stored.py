"""Reads stored results: a JSON file with a result or a list of results, or a folder with such files."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.result.class_folder import RESULT, RESULTS, folder_name_problem
from autograder.result.model import UNFINISHED, Result, from_json


def load(path: Path) -> tuple[Result, ...]:
    """Read the results at `path`.

    Args:
        path: a file with a result or a list of results, or a folder that contains `result.json` files at any depth. If
            it contains none, its `results.json` is read. The artifacts of a result in a list are in a folder beside the
            file, named after the student.

    Raises:
        UsageError: the path contains no results, or a file is not a result. The message names the file.
    """
    if not path.exists():
        raise UsageError(f"{path}: no such file or folder; use the folder that `autograder grade --out` wrote")
    if path.is_file():
        return _read(path)
    # An interrupted grading leaves its files in a folder with the name UNFINISHED.
    complete = (file for file in path.rglob(RESULT) if file.parent.name != UNFINISHED)
    files = sorted(complete) or sorted(path.glob(RESULTS))
    if not files:
        raise UsageError(f"{path} contains no {RESULT}; use the folder that `autograder grade --out` wrote")
    return tuple(result for file in files for result in _read(file))


def per_student(results: Sequence[Result], out: Path) -> list[tuple[Result, Path]]:
    """Pair each result with `out/<student>`.

    Raises:
        UsageError: a student has two results, or a student's name cannot be used as a folder name.
    """
    pairs: dict[str, tuple[Result, Path]] = {}
    for result in results:
        student = result.student
        if problem := folder_name_problem(student):
            raise UsageError(f"{problem}; or use a format without folders")
        if student in pairs:
            raise UsageError(f"the student {student!r} has two results; export one assignment at a time")
        pairs[student] = (result, out / student)
    return list(pairs.values())


def _read(file: Path) -> tuple[Result, ...]:
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise UsageError(f"{file}: cannot be read as JSON: {error}") from None
    if not isinstance(data, list):
        return (from_json(data, source=str(file), folder=file.parent),)
    results = (from_json(item, source=f"{file}, entry {index}") for index, item in enumerate(data))
    return tuple(replace(result, folder=_folder(result, file.parent)) for result in results)


def _folder(result: Result, parent: Path) -> Path:
    student_folder = parent / result.student
    return student_folder if student_folder.is_dir() else parent
