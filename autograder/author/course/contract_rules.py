"""The rules for a chapter's requirements: the cell that names a requirement contains it, and a check covers it.

A cell that names requirements must name every one that it contains, and so must a cell that an objective names as its
exercise. Each table row, each bullet, and the docstring of each function that the student writes must contain a
requirement or a text in `explains`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from nbformat import NotebookNode

from autograder.author.course.cells import metadata
from autograder.author.course.findings import Finding
from autograder.author.course.forms import Form, in_form
from autograder.author.course.schema_sentences import suggestion
from autograder.suite import Check
from autograder.suite.contract import requirements
from autograder.suite.quotation import quote


def cells_findings(name: str, notebook: NotebookNode) -> Iterator[Finding]:
    """Yield the problems with the requirements in the cells of a notebook, which findings call `name`."""
    exercises = {entry["exercise"] for entry in metadata(notebook).get("objectives", [])}
    for cell in in_form(notebook, Form.RELEASED).cells:
        yield from (Finding(name, cell.id, message) for message in _cell_findings(cell, cell.id in exercises))


def coverage_findings(
    name: str, notebook: NotebookNode, checks: Sequence[Check], locations: Mapping[str, tuple[str, int]]
) -> Iterator[Finding]:
    """Yield the requirements that no check covers, and the checks that cover no requirement of the notebook.

    `locations` maps `VISIBILITY ID` of a check to its file and line. If a check has no location, the finding names the
    notebook.
    """
    known_requirements = requirements(notebook.cells)
    covered_requirements = {name for check in checks for name in check.covers}
    for requirement in known_requirements.values():
        if not requirement.unchecked and requirement.id not in covered_requirements:
            yield Finding(name, None, f"no check covers the requirement {requirement.id!r}")
        if requirement.unchecked and requirement.id in covered_requirements:
            message = f"the requirement {requirement.id!r} is marked as unchecked, but a check covers it"
            yield Finding(name, None, message)
    for check in checks:
        unknown_ids = [requirement_id for requirement_id in check.covers if requirement_id not in known_requirements]
        messages = [f"covers {id!r}, which no cell names: {suggestion(id, known_requirements)}" for id in unknown_ids]
        file, line = locations.get(f"{check.visibility.value} {check.id}", (name, None))
        for message in messages if check.covers else ["covers no requirement"]:
            yield Finding(file, None, f"the {check.visibility.value} check {check.id!r} {message}", line)


def _cell_findings(cell: NotebookNode, is_exercise: bool) -> Iterator[str]:
    """Yield the problems with the requirements of a released cell."""
    course = metadata(cell)
    contract, explains = course.get("contract", {}), course.get("explains", [])
    quotes = {name: [texts] if isinstance(texts, str) else texts for name, texts in contract.items()}
    released_text = _normalize_spaces(cell.source)
    for name, text in [(name, text) for name, texts in quotes.items() for text in texts] + [
        ("explains", text) for text in explains
    ]:
        if _normalize_spaces(text) not in released_text:
            yield f"{name!r}: its released text does not contain the sentence {text!r}"
        elif quote(cell, text) is None:
            yield f"{name!r}: {text!r} is not a row, a sentence or part of one in the released text"
    for name in course.get("unchecked", {}):
        if name not in quotes:
            yield f"{name!r} is marked as unchecked, but is not a requirement of the cell"
    texts = [_normalize_spaces(text) for group in (*quotes.values(), explains) for text in group]
    hidden_functions = course.get("hide", [])
    names_requirements = contract or explains or hidden_functions or is_exercise
    for piece in _pieces(cell, hidden_functions) if names_requirements else ():
        if not any(text in piece for text in texts):
            advice = "give it an id in `contract`, or quote it in `explains` if it requires nothing"
            yield f"neither `contract` nor `explains` names a sentence of {piece!r}: {advice}"


def _pieces(cell: NotebookNode, hidden_functions: Sequence[str]) -> Iterator[str]:
    """Yield the rows and bullets of a Markdown cell, and the docstrings of the functions that a student writes."""
    if cell.cell_type == "code":
        function_names = {name.rpartition(".")[2] for name in hidden_functions}
        try:
            tree = ast.parse(cell.source.partition("\n")[2]) if function_names else ast.Module([], [])
        except SyntaxError:  # the cell differs from the reference, which another rule reports
            return
        for node in ast.walk(tree):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and node.name in function_names:
                yield _normalize_spaces(ast.get_docstring(node) or "")
        return
    pieces: list[list[str]] = []
    lines = cell.source.splitlines()
    for line, next_line in zip(lines, [*lines[1:], ""], strict=True):
        is_row = line.startswith("|") and not _is_delimiter_row(line)
        if line.startswith("- ") or (is_row and not _is_delimiter_row(next_line)):
            pieces.append([line])
        elif line.startswith("  ") and pieces:
            pieces[-1].append(line)
    yield from (_normalize_spaces(" ".join(piece)) for piece in pieces)


def _normalize_spaces(text: str) -> str:
    return " ".join(text.split())


def _is_delimiter_row(line: str) -> bool:
    """Return whether a line is the row of dashes below the head of a table."""
    return line.startswith("|") and set(line) <= set("|-: ")
