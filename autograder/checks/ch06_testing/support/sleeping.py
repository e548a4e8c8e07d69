"""Finds calls that sleep in Python source, which is parsed and never run."""

from __future__ import annotations

import ast

from autograder.checking.probes import files

MAX_BYTES = 256 * 1024  # a longer file fails the check
NAMES = frozenset({"sleep", "sleep_for", "sleep_until"})  # functions and methods of time, asyncio, Rate and Clock


def sleeps(source: bytes, name: str) -> list[int]:
    """Return the numbers of the lines that sleep.

    Raises:
        CheckFailed: the source is too large or is not Python. The message calls the file `name`.
    """
    nodes = list(ast.walk(files.search_python(source, MAX_BYTES, name)))
    import_aliases = [alias for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names]
    names = NAMES | {alias.asname for alias in import_aliases if alias.asname and alias.name in NAMES}
    calls = [node.func for node in nodes if isinstance(node, ast.Call)]
    return sorted(
        {function.lineno for function in calls if _function_name(function) in names or _waits_for_new_event(function)}
    )


def _waits_for_new_event(function: ast.expr) -> bool:
    """Return whether the call waits for an event that the same expression creates, so that nothing can set it."""
    owner = function.value if isinstance(function, ast.Attribute) and function.attr == "wait" else None
    return isinstance(owner, ast.Call) and _function_name(owner.func) == "Event"


def _function_name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""
