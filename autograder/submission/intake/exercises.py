"""The exercises of a chapter: its exercise cells, the files that they create, and their released form."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path, PurePosixPath
from typing import Any

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.submission.exercise_stubs import CODE_STUB, STILL_TO_BE_WRITTEN, TEXT_STUB
from autograder.submission.intake.files import SubmittedFile
from autograder.submission.intake.ignored import is_ignored
from autograder.submission.intake.names import is_notebook
from autograder.submission.intake.notebooks import Cell, read_cells
from autograder.submission.intake.writefile import same_text, written_file

SOURCE = PurePosixPath("ws/src")
BEGIN, END = "BEGIN SOLUTION", "END SOLUTION"


@dataclass(frozen=True)
class Exercises:
    """The exercises of a chapter. Paths of files are relative to `ws/src`.

    Attributes:
        targets: the released text of each file that an exercise cell writes by `%%writefile`.
        makes: the files that other cells create or change.
        makes_unknown_files: whether an exercise cell creates files that no metadata names.
        answers: the released text of each cell that students write in, by its grade id.
        locked: the grade ids of the cells that students may not change.
        ids: the grade ids of all these cells, by cell id. Tools that drop metadata keep the cell id.
        course_cells: the texts of the course's own code cells.
        given: the files that the chapter gives.
        other_files: the chapter's other files, with paths relative to its folder.
    """

    targets: Mapping[PurePosixPath, str]
    makes: frozenset[PurePosixPath]
    makes_unknown_files: bool
    answers: Mapping[str, str]
    locked: frozenset[str]
    ids: Mapping[str, str]
    course_cells: frozenset[str]
    given: Mapping[PurePosixPath, SubmittedFile]
    other_files: frozenset[PurePosixPath]

    @property
    def packages(self) -> frozenset[str]:
        """The names of the packages in `src` that the chapter gives or that its exercises write."""
        return frozenset(path.parts[0] for path in (*self.targets, *self.makes, *self.given))

    def grade_id(self, cell: Cell) -> str:
        """Return the grade id of a submitted cell, or an empty string."""
        return grade_id(cell) or self.ids.get(cell["id"], "")

    def is_as_released(self, path: PurePosixPath, data: bytes) -> bool:
        """Return whether a file is still the one that the chapter gives, or the stub of its exercise."""
        text = text_of(data)
        if path in self.given and same_text(text, text_of(self.given[path].data)):
            return True
        return is_stub(text, self.targets.get(path, ""))

    def is_complete(self, source: Mapping[PurePosixPath, bytes]) -> bool:
        """Return whether a source tree contains each file that students write, with changes since the release."""
        expected_paths = self.targets.keys() | self.makes
        return not self.makes_unknown_files and all(
            p in source and not self.is_as_released(p, source[p]) for p in expected_paths
        )


@cache
def exercises_of(assignment: str) -> Exercises | None:
    """Return the exercises of an assignment, or None if the course has no such chapter."""
    try:
        notebook = course_paths.source_notebook(assignment)
        folder = notebook.parent
    except UsageError:
        return None
    targets: dict[PurePosixPath, str] = {}
    makes: set[PurePosixPath] = set()
    answers, ids, locked, course_cells = dict[str, str](), dict[str, str](), set[str](), set[str]()
    makes_unknown_files = False
    for cell in read_cells(notebook.read_bytes()):
        name, marks, course = grade_id(cell), cell["metadata"].get("nbgrader", {}), cell["metadata"].get("course", {})
        outputs = {PurePosixPath(path).relative_to(SOURCE) for path in course.get("makes", ())}
        makes |= outputs
        if name:
            ids[cell["id"]] = name
        if name and not marks.get("solution"):
            locked.add(name)
        if cell["cell_type"] == "code" and not marks.get("solution"):
            course_cells.add(cell["source"].strip())
        if not marks.get("solution"):
            continue
        answers[name] = released = _released_text(cell)
        written = written_file(released)
        if written is not None and written[0].is_relative_to(SOURCE):
            targets[written[0].relative_to(SOURCE)] = written[1]
        elif cell["cell_type"] == "code":
            makes_unknown_files = makes_unknown_files or not outputs
    return Exercises(
        targets,
        frozenset(makes),
        makes_unknown_files,
        answers,
        frozenset(locked),
        ids,
        frozenset(course_cells),
        {p: SubmittedFile(p, file.read_bytes(), os.access(file, os.X_OK)) for p, file in _files_below(folder / SOURCE)},
        frozenset(p for p, _ in _files_below(folder) if not (p.is_relative_to(SOURCE) or is_notebook(p.name))),
    )


def grade_id(cell: Mapping[str, Any]) -> str:
    """Return the grade id in a cell's metadata, or an empty string."""
    nbgrader = cell["metadata"].get("nbgrader")
    name = nbgrader.get("grade_id") if isinstance(nbgrader, dict) else None
    return name if isinstance(name, str) else ""


def text_of(data: bytes) -> str:
    """Return a file's text, even if it is not valid UTF-8."""
    return data.decode("utf-8", "surrogateescape")


def is_stub(text: str, released: str) -> bool:
    """Return whether a text still has all the stubs of its released version."""
    return STILL_TO_BE_WRITTEN in released and text.count(STILL_TO_BE_WRITTEN) >= released.count(STILL_TO_BE_WRITTEN)


def _released_text(cell: Cell) -> str:
    """Return the text of a solution cell as nbgrader releases it, with a stub in place of each solution."""
    stub = CODE_STUB if cell["cell_type"] == "code" else TEXT_STUB
    lines: list[str] = []
    is_inside = has_solution = False
    for line in cell["source"].split("\n"):
        if not is_inside and BEGIN in line:
            is_inside = has_solution = True
            indent = line[: len(line) - len(line.lstrip())]
            lines += [indent + part for part in stub.split("\n")]
        elif is_inside and END in line:
            is_inside = False
        elif not is_inside:
            lines.append(line)
    return "\n".join(lines) if has_solution else stub


def _files_below(top: Path) -> Iterator[tuple[PurePosixPath, Path]]:
    """Yield the relative and full paths of the files below a folder of the course, except those that tools create."""
    for folder, folders, files in os.walk(top):
        folders[:] = [name for name in folders if not is_ignored(name)]
        for name in files:
            yield PurePosixPath(Path(folder, name).relative_to(top)), Path(folder, name)
