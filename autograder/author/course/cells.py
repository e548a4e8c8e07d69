"""Reads the `course` metadata of notebooks and cells. `metadata.schema.json` beside this module defines their format.

A cell that writes a file to the student's workspace names the reference file that it copies:

    {"course": {"source": "wheels/wheels/wheel_node.py", "target": "ws/src/wheels/wheels/wheel_node.py",
                "hide": ["WheelNode.turn"]}}

Sources are paths in `solutions/`. Targets are paths in the chapter's folder.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from jsonschema import Draft202012Validator
from nbformat import NotebookNode

from autograder import course_paths
from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Finding
from autograder.author.course.schema_sentences import schema_violations
from autograder.author.course.solution_markers import mark_functions, mark_lines
from autograder.probes.given_files import strip_licence

_SCHEMA = json.loads(Path(__file__).with_name("metadata.schema.json").read_text("utf-8"))
_METADATA = Draft202012Validator(_SCHEMA)
METADATA_NAME = "`course`"  # what error messages call the metadata as a whole


@dataclass(frozen=True)
class CopiedFile:
    """A reference file that a cell copies.

    In the metadata, `hidden_functions` is called `hide`, `hidden_parts` is `parts`, and `hidden_lines` is `cut`.
    """

    source: PurePosixPath
    target: PurePosixPath
    hidden_functions: tuple[str, ...]
    hidden_lines: tuple[tuple[str, str], ...]
    hidden_parts: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def expected_text(self) -> str:
        """Return the text that the cell must contain.

        Raises CourseError if the reference lacks the file, or a function or line that the metadata name.
        """
        text = strip_licence(read_solution(self.source))
        try:
            if self.hidden_functions:
                text = mark_functions(text, self.hidden_functions, self.hidden_parts)
            text = mark_lines(text, self.hidden_lines) if self.hidden_lines else text
        except CourseError as error:
            raise CourseError(f"{self.source}: {error}") from error
        return f"%%writefile {self.target}\n{text.rstrip()}"


def copied_file(cell: NotebookNode) -> CopiedFile | None:
    """Return the reference file that a code cell copies, or None."""
    course = metadata(cell)
    if "source" not in course:
        return None
    cut = tuple((before, after) for before, after in course.get("cut", ()))
    parts = {name: (before, after) for name, (before, after) in course.get("parts", {}).items()}
    return CopiedFile(
        PurePosixPath(course["source"]), PurePosixPath(course["target"]), tuple(course.get("hide", ())), cut, parts
    )


def given_files(notebook: NotebookNode) -> dict[PurePosixPath, PurePosixPath]:
    """Return the source of each reference file that is copied to the chapter's folder, by its target."""
    pairs = metadata(notebook).get("given", {})
    return {PurePosixPath(target): PurePosixPath(source) for target, source in pairs.items()}


def group(cell: NotebookNode) -> str | None:
    """Return the group of checks that belongs to a grade cell, or None."""
    return metadata(cell).get("group")


def is_graded(cell: NotebookNode) -> bool:
    """Return whether nbgrader reads points from this cell."""
    return bool(cell.metadata.get("nbgrader", {}).get("grade"))


def is_manually_graded(cell: NotebookNode) -> bool:
    """Return whether students write in this cell and an instructor awards the points in nbgrader's formgrader."""
    return is_graded(cell) and is_solution(cell)


def is_solution(cell: NotebookNode) -> bool:
    """Return whether students write in this cell."""
    return bool(cell.metadata.get("nbgrader", {}).get("solution"))


def metadata(node: NotebookNode) -> Mapping[str, Any]:
    """Return the `course` metadata of a cell or notebook. Raises CourseError if the metadata violate the schema."""
    course: Mapping[str, Any] = node.metadata.get("course", {})
    if not _METADATA.is_valid(course):
        problems = "; ".join(sentence for _, sentence in schema_violations(course, _SCHEMA, METADATA_NAME))
        raise CourseError(f"the metadata are invalid: {problems}")
    return course


def metadata_findings(name: str, notebook: NotebookNode) -> Iterator[Finding]:
    """Yield the problems in the `course` metadata of a notebook, which findings call `name`, and of its cells."""
    for cell, node in ((None, notebook), *((cell.id, cell) for cell in notebook.cells)):
        for _, sentence in schema_violations(node.metadata.get("course", {}), _SCHEMA, METADATA_NAME):
            yield Finding(name, cell, f"the metadata are invalid: {sentence}")


def read_solution(source: PurePosixPath) -> str:
    """Return the text of a reference file. Raises CourseError if the file does not exist."""
    path = course_paths.SOLUTIONS / source
    if not path.is_file():
        raise CourseError(f"the reference has no file {source}; look in solutions/")
    return path.read_text(encoding="utf-8")
