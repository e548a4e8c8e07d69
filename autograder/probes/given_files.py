"""Finds files that came with a package and that the student has changed or deleted."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping

import yaml

from autograder.probes import student_yaml
from autograder.probes.files import parse_python

MAX_BYTES = 256 * 1024  # a larger file counts as changed


def changed_files(actual: Mapping[str, bytes], given: Mapping[str, bytes], folders: Collection[str]) -> list[str]:
    """Return the given files in some of a package's folders that the student has changed or deleted.

    The ends of lines do not count, nor does the removal of the copyright comment at the start, because the cells of a
    notebook write files without it.

    Args:
        actual: the student's files, by their paths below the package's folder.
        given: the original files, by the same paths.
        folders: the names of the folders, directly below the package's folder.
    """
    names = [name for name in given if name.partition("/")[0] in folders]
    return [name for name in names if not _is_unchanged(name, actual.get(name, b""), given[name])]


def strip_licence(text: str) -> str:
    """Return Python source without the copyright comment at its start."""
    lines = text.splitlines(keepends=True)
    if not (lines and lines[0].startswith("# Copyright")):
        return text
    body = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    return "".join(lines[body:]).lstrip("\n")


def _is_unchanged(name: str, actual: bytes, given: bytes) -> bool:
    """Return whether a file has the meaning of the given one.

    The checks protect what a given module, test or configuration does. In Python, that is its syntax tree: the
    indentation counts, but neither comments nor the layout. A comment for a linter changes nothing, because `linters`
    ignores those. In YAML it is the value, unless keys are merged, which ROS does not do. In any other
    file, only the ends of lines can differ.
    """
    if len(actual) > MAX_BYTES:
        return False
    if name.endswith(".py"):
        return _tree(actual) == _tree(given)
    if name.endswith((".yaml", ".yml")) and b"<<" not in actual and _value(actual) is not None:
        return _value(actual) == _value(given)
    without_licence = strip_licence(given.decode(errors="surrogateescape")).encode(errors="surrogateescape")
    return _lines(actual) in (_lines(given), _lines(without_licence))


def _tree(source: bytes) -> str | bytes:
    """Return the syntax tree as text, or the source if it cannot be parsed. Python's own rules decode it."""
    tree = parse_python(source)
    try:
        return source if tree is None else ast.dump(tree)
    except (RecursionError, ValueError):  # ValueError: a number has too many digits to be printed
        return source


def _value(text: bytes) -> str | None:
    """Return the value of a YAML file as text, in which 1, 1.0 and true differ; None if it cannot be read."""
    try:
        return yaml.safe_dump(student_yaml.load(text))
    except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError, RecursionError):
        return None  # PyYAML raises most of these for tags and numbers that it cannot read


def _lines(text: bytes) -> list[bytes]:
    return [line.rstrip() for line in text.rstrip().splitlines()]
