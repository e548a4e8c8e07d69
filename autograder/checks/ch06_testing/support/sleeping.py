"""Finds calls of `sleep` in Python source, which is parsed and never run."""

from __future__ import annotations

import ast

from autograder.checking.probes import files

MAX_BYTES = 256 * 1024


def sleeps(source: bytes) -> list[int]:
    """Return the lines on which source calls `sleep`; none where it is no readable Python."""
    tree = files.parse_python(source) if len(source) <= MAX_BYTES else None
    calls = [node for node in ast.walk(tree or ast.Module([], [])) if isinstance(node, ast.Call)]
    return sorted(call.lineno for call in calls if _name(call.func) == "sleep")


def _name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""
