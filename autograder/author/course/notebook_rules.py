"""The rules for committed notebooks: no outputs, valid nbgrader metadata, correct headings, alternative texts."""

from __future__ import annotations

import re
from collections.abc import Iterator

import nbformat
from nbformat import NotebookNode

from autograder.author.course.cells import group, is_graded, is_manually_graded
from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Finding
from autograder.author.course.solution_markers import BEGIN_SCHEME as MARK_SCHEME

_FENCE = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)
_HEADING = re.compile(r"^(#{1,6}) +(?!BEGIN |END )\S", re.MULTILINE)  # nbgrader's markers look like headings
_IMAGE = re.compile(r"!\[(?P<alt>[^\]]*)\]\((?P<target>[^)]*)\)")
_IMG = re.compile(r"<img\b[^>]*>", re.IGNORECASE)
_ALT = re.compile(r"""\balt=(["'])\s*[^"'\s]""", re.IGNORECASE)


def rules_findings(name: str, notebook: NotebookNode) -> list[Finding]:
    """Return the rules that a source notebook with this file name breaks."""
    try:
        nbformat.validate(notebook)
    except nbformat.ValidationError as error:
        return [Finding(name, None, f"is not valid nbformat: {error.message}")]
    problems = [*_notebook_problems(notebook), *_nbgrader_problems(notebook), *_heading_problems(notebook)]
    for cell in notebook.cells:
        problems += [(cell.id, message) for message in _cell_problems(cell)]
    return [Finding(name, cell, message) for cell, message in problems]


def _notebook_problems(notebook: NotebookNode) -> Iterator[tuple[str | None, str]]:
    if (notebook.nbformat, notebook.nbformat_minor) != (4, 5):
        yield None, f"is nbformat {notebook.nbformat}.{notebook.nbformat_minor}; the course uses 4.5, with cell ids"
    kernel = notebook.metadata.get("kernelspec", {})
    if kernel.get("name") != "python3" or kernel.get("language") != "python":
        yield None, "its kernelspec must be python3, language python, so that it opens anywhere"


def _cell_problems(cell: NotebookNode) -> Iterator[str]:
    if cell.cell_type == "code":
        if cell.outputs:
            yield "has outputs; clear them before committing"
        if cell.execution_count is not None:
            yield "has an execution count; clear it before committing"
    if cell.cell_type == "markdown":
        prose = _FENCE.sub("", cell.source)
        for image in _IMAGE.finditer(prose):
            if not image["alt"].strip():
                yield f"the image {image['target']} has no alternative text"
        for tag in _IMG.findall(prose):
            if not _ALT.search(tag):
                yield f"the image {tag} has no alternative text"


def _heading_problems(notebook: NotebookNode) -> Iterator[tuple[str | None, str]]:
    level = 0
    for cell in notebook.cells:
        if cell.cell_type != "markdown":
            continue
        for match in _HEADING.finditer(_FENCE.sub("", cell.source)):
            depth = len(match[1])
            if level == 0 and depth != 1:
                yield cell.id, "the first heading of a notebook must be its title, with one #"
            elif level and depth == 1:
                yield cell.id, "a notebook must have only one title; sections start with ##"
            elif depth > level + 1:
                yield cell.id, f"a heading of level {depth} follows one of level {level}; do not skip levels"
            level = depth
    if level == 0:
        yield None, "has no title"


def _nbgrader_problems(notebook: NotebookNode) -> Iterator[tuple[str | None, str]]:
    from nbgrader.nbgraderformat import SCHEMA_VERSION, MetadataValidator, ValidationError

    for cell in notebook.cells:
        nbgrader_data = cell.metadata.get("nbgrader")
        if nbgrader_data is not None and nbgrader_data.get("schema_version") != SCHEMA_VERSION:
            yield cell.id, f"its nbgrader metadata must have schema_version {SCHEMA_VERSION}"
            return
    try:
        MetadataValidator().validate_nb(notebook)
    except ValidationError as error:
        yield None, f"its nbgrader metadata are invalid: {error}"
        return
    for cell in notebook.cells:
        nbgrader_data = cell.metadata.get("nbgrader", {})
        try:
            group_name = group(cell)
        except CourseError as error:
            yield cell.id, str(error)
            continue
        if is_graded(cell) and not is_manually_graded(cell) and (not nbgrader_data.get("locked") or group_name is None):
            yield cell.id, 'a grade cell must be locked and name its group of checks: {"course": {"group": ...}}'
        if is_manually_graded(cell):
            yield from ((cell.id, message) for message in _manual_cell_problems(cell, group_name))
        if MARK_SCHEME in cell.source and not nbgrader_data.get("locked"):
            yield cell.id, "contains a mark scheme but is not locked: lock it, so that autograding can restore it"
        if "BEGIN SOLUTION" in cell.source and not nbgrader_data.get("solution"):
            yield cell.id, "contains a solution but is not marked as a solution cell"


def _manual_cell_problems(cell: NotebookNode, group_name: str | None) -> Iterator[str]:
    nbgrader_data = cell.metadata.nbgrader
    if nbgrader_data.get("locked"):
        yield "is locked, but students must write in it: unlock it"
    if not nbgrader_data.get("points"):
        yield "a manually graded cell needs points above 0"
    if group_name is not None:
        yield f"is manually graded and cannot also belong to the group {group_name!r} of checks"
    if "BEGIN SOLUTION" not in cell.source:
        yield "a manually graded cell needs a model answer between the solution markers"
