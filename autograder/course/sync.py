"""Brings the reference solutions into the notebooks, and finds the cells and files that have gone stale."""

from __future__ import annotations

import difflib
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import nbformat
from nbformat import NotebookNode

from autograder.course.cells import given, origin, read
from autograder.course.exceptions import CourseError
from autograder.course.findings import Finding
from autograder.layout import CHAPTERS, SOLUTIONS

SHOWN_LINES = 12


@dataclass(frozen=True)
class Chapter:
    """A chapter's folder; the notebook in it has the folder's name."""

    folder: Path

    @property
    def assignment(self) -> str:
        """Return nbgrader's name for it."""
        return self.folder.name

    @property
    def path(self) -> Path:
        """Return the notebook's path."""
        return self.folder / f"{self.folder.name}.ipynb"

    def read(self) -> NotebookNode:
        """Read the notebook.

        Raises:
            CourseError: there is none, or it is not a notebook.
        """
        if not self.path.is_file():
            raise CourseError(f"{self.folder.name}: a chapter's folder holds a notebook of its own name")
        text = self.path.read_text(encoding="utf-8")
        try:
            with warnings.catch_warnings():
                # nbformat would hand out new ids; grades and findings hang on the old ones.
                warnings.simplefilter("error", nbformat.warnings.DuplicateCellId)
                warnings.simplefilter("error", nbformat.warnings.MissingIDFieldWarning)
                notebook: NotebookNode = nbformat.reads(text, as_version=nbformat.NO_CONVERT)
        except (nbformat.warnings.DuplicateCellId, nbformat.warnings.MissingIDFieldWarning) as error:
            raise CourseError(f"{self.path.name}: each cell needs an id of its own: {error}") from error
        except (nbformat.reader.NotJSONError, nbformat.ValidationError) as error:
            raise CourseError(f"{self.path.name} is not a notebook: {error}") from error
        if notebook.get("nbformat") != nbformat.current_nbformat:
            raise CourseError(f"{self.path.name} is not a notebook of format {nbformat.current_nbformat}")
        return notebook

    def write(self, notebook: NotebookNode) -> None:
        """Write the notebook."""
        write_notebook(self.path, notebook)


def write_notebook(path: Path, notebook: NotebookNode) -> None:
    """Write a notebook in nbformat's own form, the one that diffs well."""
    path.write_text(nbformat.writes(notebook) + "\n", encoding="utf-8")


def chapters(root: Path = CHAPTERS) -> list[Chapter]:
    """Return the chapters in their order."""
    return [Chapter(path.parent) for path in sorted(root.glob("*/*.ipynb")) if path.stem == path.parent.name]


def stale(chapter: Chapter, solutions: Path = SOLUTIONS) -> list[Finding]:
    """Find the cells and files that differ from the reference, or whose metadata is wrong."""
    notebook = chapter.read()
    return [finding for finding, _ in _differences(chapter, notebook, solutions)]


def sync(chapter: Chapter, solutions: Path = SOLUTIONS) -> list[Finding]:
    """Bring a chapter up to date; return what had been stale.

    Raises:
        CourseError: something is wrong that copying cannot mend; nothing is written then.
    """
    notebook = chapter.read()
    differences = list(_differences(chapter, notebook, solutions))
    for finding, mend in differences:
        if mend is None:
            raise CourseError(str(finding))
    for _, mend in differences:
        if mend is not None:
            mend.apply()
    if any(finding.cell is not None for finding, _ in differences):
        chapter.write(notebook)
    return [finding for finding, _ in differences]


@dataclass(frozen=True)
class _Mend:
    """The text that a cell or a file should have."""

    to: NotebookNode | Path
    text: str

    def apply(self) -> None:
        if isinstance(self.to, Path):
            self.to.parent.mkdir(parents=True, exist_ok=True)
            self.to.write_text(self.text, encoding="utf-8")
        else:
            self.to.source = self.text


def _differences(chapter: Chapter, notebook: NotebookNode, solutions: Path) -> Iterator[tuple[Finding, _Mend | None]]:
    """Yield what is wrong, with the mend where copying is one."""
    name = chapter.path.name
    for cell in notebook.cells:
        cell_id = cell.get("id", "without id")
        try:
            source = origin(cell)
            expected = None if source is None else source.text(solutions)
        except CourseError as error:
            yield Finding(name, cell_id, str(error)), None
            continue
        if expected is not None and source is not None and cell.source != expected:
            message = f"differs from solutions/{source.source}; run `autograder course sync`"
            yield Finding(name, cell_id, message + _diff(cell.source, expected)), _Mend(cell, expected)
    try:
        pairs = given(notebook)
        texts = {target: read(solutions, source) for target, source in pairs.items()}
    except CourseError as error:
        yield Finding(name, None, str(error)), None
        return
    for target, text in texts.items():
        path = chapter.folder / target
        current = path.read_text(encoding="utf-8") if path.is_file() else None
        if current != text:
            what = "is missing" if current is None else "differs"
            message = f"the given file {target} {what}; solutions/{pairs[target]} holds it; "
            message += "run `autograder course sync`"
            yield Finding(name, None, message + _diff(current or "", text)), _Mend(path, text)


def _diff(current: str, expected: str) -> str:
    """Show the first lines that differ."""
    lines = difflib.unified_diff(current.splitlines(), expected.splitlines(), "notebook", "reference", n=1, lineterm="")
    shown = list(lines)[2:]
    more = [f"... and {len(shown) - SHOWN_LINES} more lines"] if len(shown) > SHOWN_LINES else []
    return "".join(f"\n    {line}" for line in shown[:SHOWN_LINES] + more)
