"""Selects the files of a submission that count: those in `ws/src`, which `check` also reads.

A file that is missing, or unchanged since its release, is taken from the cell of the notebook that writes it. If other
code creates the file, the notebook has to run.
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
        texts: the text of each file below `ws/src` that a cell writes. If several cells write it, the last
            one with the fewest stubs counts.
        has_other_code: whether a cell that the student wrote does anything else.
    """

    texts: Mapping[PurePosixPath, str]
    has_other_code: bool


@dataclass(frozen=True)
class GradedPackages:
    """The packages that are graded, with notices for the student. `packages` is None if the notebook has to run."""

    packages: tuple[SubmittedFile, ...] | None
    notices: tuple[str, ...] = ()


def read_code(cells: Sequence[Cell], exercises: Exercises) -> Cells:
    """Return the effects of the code cells of a submitted notebook."""
    texts: dict[PurePosixPath, str] = {}
    has_other_code = False
    for cell in cells:
        name, source = exercises.grade_id(cell), cell["source"]
        if name in exercises.locked or (cell["cell_type"] != "code" and name not in exercises.answers):
            continue
        written = written_file(source)
        if written is not None:
            path = written[0]
            if path.is_relative_to(SOURCE) and path != SOURCE:
                path = path.relative_to(SOURCE)
                current = texts.get(path, "")
                if path not in texts or _stub_count(written[1]) <= _stub_count(current):
                    texts[path] = written[1]
        elif source.strip() and source.strip() not in exercises.course_cells:
            is_unanswered = name in exercises.answers and same_text(source, exercises.answers[name])
            has_other_code = has_other_code or not (is_unanswered or cell["cell_type"] == "markdown")
    return Cells(texts, has_other_code)


def with_given(source: Files, exercises: Exercises) -> dict[PurePosixPath, SubmittedFile]:
    """Return a source tree, extended by the given packages of the chapter that it lacks."""
    existing = {path.parts[0] for path in source}
    return {**{p: file for p, file in exercises.given.items() if p.parts[0] not in existing}, **source}


def count(source: Files, cells: Cells, exercises: Exercises) -> GradedPackages:
    """Return the packages to grade from a source tree and the cells of a notebook, without running it."""
    changed_paths = {path for path, file in source.items() if not exercises.is_as_released(path, file.data)}
    missing_paths = (exercises.targets.keys() | exercises.makes) - changed_paths
    if exercises.makes_unknown_files or (missing_paths and (cells.has_other_code or missing_paths & exercises.makes)):
        return GradedPackages(None)
    files = with_given(source, exercises)
    from_cells = {
        path: text
        for path, text in cells.texts.items()
        if path not in changed_paths and not (path in files and is_stub(text, exercises.targets.get(path, "")))
    }
    _add_without_conflicts(
        files, (SubmittedFile(path, text.encode("utf-8", "replace")) for path, text in from_cells.items())
    )
    notices = []
    for path in sorted(exercises.targets):
        text = cells.texts.get(path)
        if text is None or is_stub(text, exercises.targets[path]):
            continue
        if path in changed_paths and not same_text(text, text_of(source[path].data)):
            notices.append(difference_notice(path))
        elif path in from_cells and source:
            notices.append(_cell_notice(path, exists=path in source))
    return GradedPackages(tuple(files[path] for path in sorted(files)), tuple(notices))


def merge(source: Files, written: Sequence[SubmittedFile], exercises: Exercises) -> GradedPackages:
    """Return the packages to grade from a source tree and the files that the notebook wrote.

    Changed files of the source tree take precedence, because `check` read them.
    """
    by_path = {file.path: file for file in written}
    changed_files = {path: file for path, file in source.items() if not exercises.is_as_released(path, file.data)}
    files = dict(changed_files)
    _add_without_conflicts(files, (file for path, file in by_path.items() if path not in changed_files))
    expected_paths = exercises.targets.keys() | exercises.makes
    notices = [
        difference_notice(path)
        for path in sorted(expected_paths & changed_files.keys() & by_path.keys())
        if not same_text(text_of(by_path[path].data), text_of(changed_files[path].data))
    ]
    return GradedPackages(tuple(files[path] for path in sorted(files)), tuple(notices))


def difference_notice(path: PurePosixPath) -> str:
    """Return the sentence about a file that differs from its cell."""
    return (
        f"{SOURCE / path} differs from the cell that writes it. The file counts, because check(...) reads it. "
        "To use the text of the cell, run the cell."
    )


def _cell_notice(path: PurePosixPath, *, exists: bool) -> str:
    reason = "the file was still the released one" if exists else "there was no such file"
    return f"{SOURCE / path} was taken from the notebook's cell: {reason}. Run the cell before check(...)."


def _add_without_conflicts(files: dict[PurePosixPath, SubmittedFile], additions: Iterable[SubmittedFile]) -> None:
    """Add files to a tree, except those that conflict with a folder or a file of the tree."""
    folders = {folder for path in files for folder in path.parents}
    for file in additions:
        if file.path not in folders and not any(folder in files for folder in file.path.parents):
            files[file.path] = file
            folders.update(file.path.parents)


def _stub_count(text: str) -> int:
    return text.count(STILL_TO_BE_WRITTEN)
