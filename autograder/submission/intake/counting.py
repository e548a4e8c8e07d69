"""Merges the files of a submission that count: those in `ws/src`, as `check` sees them.

A file that is missing, or still as it was released, is taken from the cell of the notebook that writes it. Where files
are made by other code, the notebook has to run.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from autograder.submission.exercise_stubs import STILL_TO_BE_WRITTEN
from autograder.submission.intake.exercises import SOURCE, Exercises, is_stub, text_of
from autograder.submission.intake.files import SubmittedFile
from autograder.submission.intake.notebooks import Cell
from autograder.submission.intake.writefile import same_text, written_file

Files = Mapping[PurePosixPath, SubmittedFile]


@dataclass(frozen=True)
class Cells:
    """The effects of a notebook's code cells.

    Attributes:
        texts: the text of each file below `ws/src` that a cell only writes; the last cell without a stub counts.
        others: whether a cell that is not the course's own does anything else.
    """

    texts: Mapping[PurePosixPath, str]
    others: bool


@dataclass(frozen=True)
class Counted:
    """The packages that are graded, and sentences about them for the student. Without packages the notebook runs."""

    packages: tuple[SubmittedFile, ...] | None
    notices: tuple[str, ...] = ()


def read_code(cells: Sequence[Cell], exercises: Exercises) -> Cells:
    """Return the effects of the code cells of a submitted notebook."""
    texts: dict[PurePosixPath, str] = {}
    others = False
    for cell in cells:
        name, source = exercises.grade_id(cell), cell["source"]
        if name in exercises.locked or (cell["cell_type"] != "code" and name not in exercises.answers):
            continue
        written = written_file(source)
        if written is not None:
            path = written[0]
            if path.is_relative_to(SOURCE) and path != SOURCE:
                path = path.relative_to(SOURCE)
                before = texts.get(path, "")
                if path not in texts or _stubs(written[1]) <= _stubs(before):
                    texts[path] = written[1]
        elif source.strip() and source.strip() not in exercises.known:
            answered = name in exercises.answers and same_text(source, exercises.answers[name])
            others = others or not (answered or cell["cell_type"] == "markdown")
    return Cells(texts, others)


def with_given(source: Files, exercises: Exercises) -> dict[PurePosixPath, SubmittedFile]:
    """Return a source tree with the packages that the chapter gives and the tree lacks."""
    there = {path.parts[0] for path in source}
    return {**{p: file for p, file in exercises.given.items() if p.parts[0] not in there}, **source}


def count(source: Files, cells: Cells, exercises: Exercises) -> Counted:
    """Return the files that count of a source tree and a notebook, without running the notebook."""
    counting = {path for path, file in source.items() if not exercises.is_as_released(path, file.data)}
    missing = (exercises.targets.keys() | exercises.makes) - counting
    if exercises.unknown or (missing and (cells.others or missing & exercises.makes)):
        return Counted(None)
    files = with_given(source, exercises)
    taken = {
        path: text
        for path, text in cells.texts.items()
        if path not in counting and not (path in files and is_stub(text, exercises.targets.get(path, "")))
    }
    _add_what_fits(files, (SubmittedFile(path, text.encode("utf-8", "replace")) for path, text in taken.items()))
    notices = []
    for path in sorted(exercises.targets):
        text = cells.texts.get(path)
        if text is None or is_stub(text, exercises.targets[path]):
            continue
        if path in counting and not same_text(text, text_of(source[path].data)):
            notices.append(differs(path))
        elif path in taken and source:
            notices.append(_from_cell(path, there=path in source))
    return Counted(tuple(files[path] for path in sorted(files)), tuple(notices))


def merge(source: Files, written: Sequence[SubmittedFile], exercises: Exercises) -> Counted:
    """Return the files that count of a source tree and of the notebook's tree: those that `check` saw come first."""
    ran = {file.path: file for file in written}
    counting = {path: file for path, file in source.items() if not exercises.is_as_released(path, file.data)}
    files = dict(counting)
    _add_what_fits(files, (file for path, file in ran.items() if path not in counting))
    expected = exercises.targets.keys() | exercises.makes
    notices = [
        differs(path)
        for path in sorted(expected & counting.keys() & ran.keys())
        if not same_text(text_of(ran[path].data), text_of(counting[path].data))
    ]
    return Counted(tuple(files[path] for path in sorted(files)), tuple(notices))


def differs(path: PurePosixPath) -> str:
    """Return the sentence about a file that differs from its cell."""
    return (
        f"{SOURCE / path} differs from the cell that writes it. The file counts: it is what check(...) looks at. "
        "If you mean the text of the cell, run the cell."
    )


def _from_cell(path: PurePosixPath, *, there: bool) -> str:
    why = "the file was still the released one" if there else "there was no such file"
    return f"{SOURCE / path} was taken from the notebook's cell: {why}. Run the cell before check(...)."


def _add_what_fits(files: dict[PurePosixPath, SubmittedFile], more: Iterable[SubmittedFile]) -> None:
    """Add files to a tree, except those that conflict with a folder or file there."""
    folders = {folder for path in files for folder in path.parents}
    for file in more:
        if file.path not in folders and not any(folder in files for folder in file.path.parents):
            files[file.path] = file
            folders.update(file.path.parents)


def _stubs(text: str) -> int:
    return text.count(STILL_TO_BE_WRITTEN)
