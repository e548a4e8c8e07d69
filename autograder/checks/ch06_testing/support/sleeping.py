"""Finds sleeps in Python source, which is parsed and never run."""

from __future__ import annotations

import ast

from autograder.checking.probes import files

MAX_BYTES = 256 * 1024
NAMES = frozenset({"sleep", "sleep_for", "sleep_until"})  # of time, asyncio, Rate and Clock


def sleeps(source: bytes) -> list[int]:
    """Return the lines on which source sleeps; none where it is no readable Python."""
    tree = files.parse_python(source) if len(source) <= MAX_BYTES else None
    nodes = list(ast.walk(tree or ast.Module([], [])))
    imported = [alias for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names]
    names = NAMES | {alias.asname for alias in imported if alias.asname and alias.name in NAMES}
    calls = [node.func for node in nodes if isinstance(node, ast.Call)]
    return sorted({function.lineno for function in calls if _name(function) in names or _waits_in_vain(function)})


def _waits_in_vain(function: ast.expr) -> bool:
    """Whether it is `wait` of an event that was made in the same expression, so that nobody can ever set it."""
    made = function.value if isinstance(function, ast.Attribute) and function.attr == "wait" else None
    return isinstance(made, ast.Call) and _name(made.func) == "Event"


def _name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""
