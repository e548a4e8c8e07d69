"""Parses the Python files of a course without running them: their syntax, names and checks."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from autograder.author.course.findings import Finding, display_path

Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class PythonFile:
    """A Python file.

    Attributes:
        label: its path in findings.
        tree: its syntax tree, which is empty if the file cannot be parsed.
        findings: the syntax error, if it cannot be parsed.
    """

    label: str
    tree: ast.Module = field(default_factory=lambda: ast.Module([], []))
    findings: tuple[Finding, ...] = ()

    def finding(self, node: ast.AST | None, message: str) -> Finding:
        """Return a finding at a node, or at the first line."""
        return Finding(self.label, None, message, getattr(node, "lineno", 1))

    def functions(self) -> list[Function]:
        """Return the top-level functions of the file."""
        return [node for node in self.tree.body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]

    def constants(self) -> Iterator[tuple[str, ast.expr]]:
        """Yield the file's top-level constants (upper-case names) with their values."""
        for node in self.tree.body:
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            value = getattr(node, "value", None)
            for target in targets:
                if isinstance(target, ast.Name) and target.id.isupper() and value is not None:
                    yield target.id, value


def read_python(path: Path) -> PythonFile:
    """Parse an existing Python file."""
    label = display_path(path)
    try:
        return PythonFile(label, ast.parse(path.read_bytes(), filename=label))
    except (SyntaxError, ValueError) as error:  # a null byte is a ValueError
        reason, line = getattr(error, "msg", error), getattr(error, "lineno", None) or 1
        return PythonFile(label, findings=(Finding(label, None, f"is not Python: {reason}", line),))


def decorator_name(decorator: ast.expr) -> str:
    """Return the name of a decorator without its module and arguments."""
    function = decorator.func if isinstance(decorator, ast.Call) else decorator
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def decorators(function: Function) -> dict[str, ast.expr]:
    """Return the decorators of a function by name."""
    return {decorator_name(decorator): decorator for decorator in function.decorator_list}


def declaration(function: Function) -> ast.Call | None:
    """Return the decorator that declares a check (it is called `check` or has points), or None."""
    calls = (decorator for decorator in function.decorator_list if isinstance(decorator, ast.Call))
    return next((call for call in calls if decorator_name(call) == "check" or argument(call, "points")), None)


def argument(call: ast.Call, name: str) -> ast.expr | None:
    """Return the value of a named argument of a call, or None."""
    return next((keyword.value for keyword in call.keywords if keyword.arg == name), None)


def literal(node: ast.expr | None) -> Any:
    """Return the value of a literal expression, or None."""
    try:
        return None if node is None else ast.literal_eval(node)
    except ValueError:
        return None
