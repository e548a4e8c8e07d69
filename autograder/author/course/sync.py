"""Copies the reference solutions and the points of the suites into the notebooks, and finds differences."""

from __future__ import annotations

import difflib
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import nbformat
from nbformat import NotebookNode

from autograder import course_paths
from autograder.author.course.cells import copied_file, given_files, is_graded, read_solution
from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Difference, Finding
from autograder.author.course.points import point_differences
from autograder.result.model import write_atomically
from autograder.suite import suites

MAX_DIFF_LINES = 12  # how many lines of a difference are shown; further ones are counted


@dataclass(frozen=True)
class Chapter:
    """A chapter's folder, with a notebook of the same name."""

    folder: Path

    @property
    def assignment(self) -> str:
        """The name that nbgrader uses."""
        return self.folder.name

    @property
    def notebook_path(self) -> Path:
        """The path of the notebook."""
        return self.folder / f"{self.folder.name}.ipynb"

    def read(self) -> NotebookNode:
        """Read the notebook. Raises CourseError if it is missing or has another format."""
        if not self.notebook_path.is_file():
            raise CourseError(f"{self.folder.name}: the folder has no notebook {self.folder.name}.ipynb: create it")
        text = self.notebook_path.read_text(encoding="utf-8")
        try:
            with warnings.catch_warnings():
                # Otherwise nbformat assigns new ids, but grades and findings refer to the old ones.
                warnings.simplefilter("error", nbformat.warnings.DuplicateCellId)
                warnings.simplefilter("error", nbformat.warnings.MissingIDFieldWarning)
                notebook: NotebookNode = nbformat.reads(text, as_version=nbformat.NO_CONVERT)
        except (nbformat.warnings.DuplicateCellId, nbformat.warnings.MissingIDFieldWarning) as error:
            raise CourseError(f"{self.notebook_path.name}: each cell needs a unique id: {error}") from error
        except (nbformat.reader.NotJSONError, nbformat.ValidationError) as error:
            raise CourseError(f"{self.notebook_path.name} is not a notebook: {error}") from error
        if notebook.get("nbformat") != nbformat.current_nbformat:
            raise CourseError(f"{self.notebook_path.name} is not a notebook of format {nbformat.current_nbformat}")
        return notebook

    def write(self, notebook: NotebookNode) -> None:
        """Write the notebook."""
        nbformat.write(notebook, self.notebook_path)


def chapters(names: Sequence[str] = ()) -> list[Chapter]:
    """Return the chapters with these names, by default all in order. Raises UsageError if one does not exist."""
    return [Chapter(course_paths.chapter(name)) for name in names or course_paths.assignments()]


def find_outdated(
    chapter: Chapter, notebook: NotebookNode | None = None, points: Mapping[str, float] | None = None
) -> list[Finding]:
    """Return the cells and files that differ from the reference or the suite, and those with invalid metadata.

    Args:
        chapter: the chapter.
        notebook: its notebook; read from the chapter if None.
        points: the points of each group of its hidden suite, or None to skip the comparison.
    """
    notebook = chapter.read() if notebook is None else notebook
    return [finding for finding, _ in _differences(chapter, notebook, points)]


def sync_chapter(chapter: Chapter, *, write: bool = True) -> list[Finding]:
    """Copy the reference and the suite's points into a chapter, and return the cells and files that differed.

    Without `write`, nothing is written. Raises CourseError, and writes nothing, if there is a problem that only an
    author can fix.
    """
    notebook = chapter.read()
    is_graded_chapter = any(map(is_graded, notebook.cells))
    points = suites.hidden(chapter.assignment).groups if is_graded_chapter else None
    differences = list(_differences(chapter, notebook, points))
    for finding, fix in differences:
        if fix is None:
            raise CourseError(str(finding))
    for _, fix in differences if write else ():
        if fix is not None:
            fix()
    if write and any(finding.cell is not None for finding, _ in differences):
        chapter.write(notebook)
    return [finding for finding, _ in differences]


def _differences(chapter: Chapter, notebook: NotebookNode, points: Mapping[str, float] | None) -> Iterator[Difference]:
    name = chapter.notebook_path.name
    if points is not None:
        yield from point_differences(name, notebook, points)
    for cell in notebook.cells:
        try:
            copy = copied_file(cell)
            expected_text = None if copy is None else copy.expected_text()
        except CourseError as error:
            yield Finding(name, cell.id, str(error)), None
            continue
        if expected_text is not None and copy is not None and cell.source != expected_text:
            message = f"differs from solutions/{copy.source}; run `autograder course sync`"
            finding = Finding(name, cell.id, message + _diff(cell.source, expected_text))
            yield finding, partial(setattr, cell, "source", expected_text)
    try:
        pairs = given_files(notebook)
        texts = {target: read_solution(source) for target, source in pairs.items()}
    except CourseError as error:
        yield Finding(name, None, str(error)), None
        return
    for target, text in texts.items():
        path = chapter.folder / target
        current = path.read_text(encoding="utf-8") if path.is_file() else None
        if current != text:
            state = "is missing" if current is None else "differs"
            message = f"the given file {target} {state}; its source is solutions/{pairs[target]}; "
            message += "run `autograder course sync`" + _diff(current or "", text)
            yield Finding(name, None, message), partial(write_atomically, path, text.encode())


def _diff(current: str, expected: str) -> str:
    """Return the first differing lines, indented."""
    lines = difflib.unified_diff(current.splitlines(), expected.splitlines(), "notebook", "reference", n=1, lineterm="")
    diff_lines = list(lines)[2:]
    omission = [f"... and {len(diff_lines) - MAX_DIFF_LINES} more lines"] if len(diff_lines) > MAX_DIFF_LINES else []
    return "".join(f"\n    {line}" for line in diff_lines[:MAX_DIFF_LINES] + omission)
