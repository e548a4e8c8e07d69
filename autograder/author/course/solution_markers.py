"""Writes nbgrader's solution markers around answers. nbgrader removes the text between them from a release.

In Python, the answers are the bodies of the given functions, located with `ast`, or the part of a body between two
given lines. In other files, they are the lines between two given lines. A missing function or line is an error, because
the answer would otherwise be released.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from autograder.author.course.exceptions import CourseError

BEGIN = "# BEGIN SOLUTION"
END = "# END SOLUTION"
BEGIN_SCHEME = "### BEGIN MARK SCHEME"

Function = ast.FunctionDef | ast.AsyncFunctionDef


def mark_functions(text: str, hide: Sequence[str], parts: Mapping[str, tuple[str, str]] | None = None) -> str:
    """Return Python source with solution markers around the bodies of the functions in `hide`.

    Signature, decorators and docstring are outside the markers, because the student needs them. Names are qualified:
    `main`, `RobotController.control_loop`. For a function in `parts`, the markers enclose only the part of its body
    between two lines, which are given as in `mark_lines`. Raises CourseError if one of the bodies cannot be marked.
    """
    parts = parts or {}
    if unknown_parts := sorted(parts.keys() - set(hide)):
        raise CourseError(f"`parts` names {', '.join(unknown_parts)}, which `hide` does not name")
    try:
        functions = list(_functions(ast.parse(text)))
    except SyntaxError as error:
        raise CourseError(f"the source does not parse: {error.msg} in line {error.lineno}") from error
    regions = []
    for name in hide:
        matches = [function for qualified_name, function in functions if qualified_name == name]
        if len(matches) != 1:
            known_names = ", ".join(sorted({qualified_name for qualified_name, _ in functions})) or "none"
            raise CourseError(
                f"function {name!r} occurs {len(matches)} times in the source; its functions: {known_names}"
            )
        region = _region(name, matches[0])
        regions.append(_part(text, region, *parts[name]) if name in parts else region)
    return _insert_markers(text, regions)


def mark_lines(text: str, cuts: Sequence[tuple[str, str]]) -> str:
    """Return text of any kind with solution markers around the lines between each pair of lines.

    The lines of a pair are given without indentation. Each must occur once in the text. An empty string means the start
    or the end of the file. Raises CourseError if one of the regions cannot be marked.
    """
    whole = (0, len(text.splitlines()), 0)
    return _insert_markers(text, [_part(text, whole, before, after) for before, after in cuts])


def strip_markers(text: str) -> str:
    """Return the text without solution markers, as in a solved notebook."""
    return "\n".join(line for line in text.split("\n") if line.strip() not in (BEGIN, END))


def _insert_markers(text: str, regions: list[tuple[int, int, int]]) -> str:
    """Return text with markers around regions: (index of the first line, index after the last, indentation)."""
    if BEGIN in text or END in text:
        raise CourseError("the source contains solution markers: remove them, they belong only in notebooks")
    regions.sort()
    if any(before[1] > after[0] for before, after in pairwise(regions)):
        raise CourseError("nested parts cannot both be hidden")
    lines = text.splitlines()
    for first, end, indent in reversed(regions):
        lines[end:end] = [" " * indent + END]
        lines[first:first] = [" " * indent + BEGIN]
    return "\n".join(lines) + "\n"


def _part(text: str, region: tuple[int, int, int], before: str, after: str) -> tuple[int, int, int]:
    """Return the part of a region between two of its lines, in the form that `_insert_markers` takes."""
    start, stop, _ = region
    lines = text.splitlines()[start:stop]
    first, end = _line_index(lines, before, -1) + 1, _line_index(lines, after, len(lines))
    first_nonempty = next((line for line in lines[first:end] if line.strip()), None)
    if first_nonempty is None:
        raise CourseError(f"no text to hide between the lines {before!r} and {after!r}")
    return start + first, start + end, len(first_nonempty) - len(first_nonempty.lstrip())


def _line_index(lines: Sequence[str], text: str, default: int) -> int:
    """Return the index of the line `text`, or the default for an empty string."""
    if not text:
        return default
    indices = [index for index, line in enumerate(lines) if line.strip() == text]
    if len(indices) != 1:
        raise CourseError(f"the line {text!r} occurs {len(indices)} times in the source")
    return indices[0]


def _functions(node: ast.AST, prefix: str = "") -> Iterator[tuple[str, Function]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            qualified_name = prefix + child.name
            if not isinstance(child, ast.ClassDef):
                yield qualified_name, child
            yield from _functions(child, qualified_name + ".")
        else:
            yield from _functions(child, prefix)


def _region(name: str, function: Function) -> tuple[int, int, int]:
    """Return the region of a function's body after its docstring, in the form that `_insert_markers` takes."""
    if ast.get_docstring(function, clean=False) is None:
        raise CourseError(f"function {name!r} has no docstring: write one, students see it in place of the body")
    # The region starts right after the docstring, because a comment above the first statement may reveal the answer.
    first, end = function.body[0].end_lineno, function.body[-1].end_lineno
    assert first is not None, "ast.parse sets it"
    assert end is not None, "ast.parse sets it"
    if first >= end:
        raise CourseError(f"function {name!r} has no separate lines to hide after its docstring")
    return first, end, function.body[0].col_offset
