"""Rewrites correct answers in other styles without changing their behaviour. Rewritten answers must keep all points.

Like the mutation operators, a rewrite changes the text at the positions that `ast` reports.
"""

from __future__ import annotations

import ast
import functools
import io
import re
import subprocess
import sys
import tokenize
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from importlib.util import find_spec

from autograder.author.verification.python_operators import (
    FUNCTIONS,
    SYMBOLS,
    NodeInContext,
    Replacement,
    Source,
    nodes_in_context,
    replaced,
)

MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}
# Operands that bind more tightly than a comparison.
TIGHT_OPERANDS = (ast.Attribute, ast.BinOp, ast.Call, ast.Constant, ast.Name, ast.Subscript, ast.UnaryOp)
MAX_COLUMNS = 99  # the longest line that the ROS linters accept

Function = ast.FunctionDef | ast.AsyncFunctionDef


def rewritten(text: str) -> str:
    """Return an equivalent module.

    Comparisons are mirrored, conditional expressions inverted, augmented assignments expanded, local variables renamed
    and methods reordered. Functions get return types, which are not evaluated.
    """
    for rewriting in REWRITINGS:
        source = Source(text)
        nodes = [context for _, context in nodes_in_context(source, None)]
        text = replaced(source.data, tuple(rewriting(source, nodes))).decode()
    return text


def formatted(text: str) -> str:
    """Format a module with ruff. The quotes are preserved, because ROS has its own rule for them."""
    command = [sys.executable, "-m", "ruff", "format", "--isolated", f"--line-length={MAX_COLUMNS}"]
    command += ["--config", "format.quote-style='preserve'", "-"]
    return subprocess.run(command, cwd="/", input=text, stdout=subprocess.PIPE, text=True, check=True).stdout


def rewrites() -> Mapping[str, Callable[[str], str]]:
    """Return the available rewrites by name. `formatted` needs ruff, which is installed only for developers."""
    return {"rewritten": rewritten, "formatted": formatted} if find_spec("ruff") else {"rewritten": rewritten}


def _only_fitting(
    rewriting: Callable[[Source, list[NodeInContext]], Iterator[Replacement]],
) -> Callable[[Source, list[NodeInContext]], Iterator[Replacement]]:
    """Keep only the replacements that do not overlap, stay within one line, and do not make the line too long."""

    @functools.wraps(rewriting)
    def filter_replacements(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
        last_end = -1
        for start, end, new in sorted(rewriting(source, nodes), key=lambda change: (change[0], -change[1])):
            first, last = source.data.rfind(b"\n", 0, start) + 1, source.data.find(b"\n", end)
            columns = (start - first) + len(new) + (last - end)
            if start > last_end and b"\n" not in source.data[start:end] and columns <= MAX_COLUMNS:
                yield start, end, new
                last_end = end

    return filter_replacements


@_only_fitting
def mirrored_comparisons(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield `b > a` for `a < b`, unless both sides contain calls, whose order may matter."""
    for context in nodes:
        node = context.node
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            sides = (node.left, node.comparators[0])
            symbol = MIRRORED.get(SYMBOLS[type(node.ops[0])])
            if symbol and not all(_contains_call(side) for side in sides):
                left, right = (_operand(source, side) for side in sides)
                yield (*source.span(node), f"{right} {symbol} {left}")


@_only_fitting
def inverted_conditions(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield `b if not c else a` for `a if c else b`."""
    for context in nodes:
        node = context.node
        if isinstance(node, ast.IfExp):
            body, test, other = (_operand(source, part) for part in (node.body, node.test, node.orelse))
            yield (*source.span(node), f"{other} if not {test} else {body}")


@_only_fitting
def expanded_increments(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield `x = x + 1` for `x += 1` if a constant is added. For a list, the rewrite would create a new list."""
    for context in nodes:
        node = context.node
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add) and isinstance(node.value, ast.Constant):
            target = source.text(node.target)
            yield (*source.span(node), f"{target} = {target} + {source.text(node.value)}")


def renamed_variables(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield a new name of the same length for each local variable, so that continuation lines stay aligned."""
    used_names = set(re.findall(r"\w+", source.data.decode()))
    for context in nodes:
        function = context.node
        if not isinstance(function, FUNCTIONS) or any(isinstance(outer, FUNCTIONS) for outer in context.ancestors):
            continue
        new_names = {name: f"{name[:-1]}_" for name in _variables(function) if len(name) > 1}
        unique_names = {name for name, count in Counter(new_names.values()).items() if count == 1} - used_names
        for node in ast.walk(function):
            if isinstance(node, ast.Name) and new_names.get(node.id) in unique_names:
                yield (*source.span(node), new_names[node.id])


def reordered_methods(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield the methods of each class, except `__init__`, in reverse order."""
    for node in (context.node for context in nodes if isinstance(context.node, ast.ClassDef)):
        methods = [method for method in node.body if isinstance(method, FUNCTIONS) and method.name != "__init__"]
        names = {method.name for method in methods}
        decorators = [ast.walk(decorator) for method in methods for decorator in method.decorator_list]
        needed_names = {part.id for walk in decorators for part in walk if isinstance(part, ast.Name)}
        if len(names) == len(methods) and not needed_names & names:
            spans = [_span_with_decorators(source, method) for method in methods]
            for (start, end), (first, last) in zip(spans, reversed(spans), strict=True):
                yield start, end, source.data[first:last].decode()


@_only_fitting
def return_types(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield `-> None` for each function that returns nothing."""
    for node in (context.node for context in nodes if isinstance(context.node, FUNCTIONS)):
        results = [
            part
            for part in ast.walk(node)
            if isinstance(part, ast.Yield | ast.YieldFrom) or (isinstance(part, ast.Return) and part.value)
        ]
        if node.returns is None and not results:
            colon = _end_of_header(source, node)
            yield colon, colon, " -> None"


def postponed_annotations(source: Source, nodes: list[NodeInContext]) -> Iterator[Replacement]:
    """Yield `from __future__ import annotations` below the module's docstring."""
    body = source.tree.body
    if nodes and ast.get_docstring(source.tree) and "__future__" not in source.data.decode():
        end = source.span(body[0])[1]
        yield end, end, "\n\nfrom __future__ import annotations"


def _contains_call(node: ast.AST) -> bool:
    return any(isinstance(part, ast.Call | ast.Await) for part in ast.walk(node))


def _operand(source: Source, node: ast.expr) -> str:
    return source.text(node) if isinstance(node, TIGHT_OPERANDS) else f"({source.text(node)})"


def _variables(function: Function) -> set[str]:
    """Return the names that a function uses only as variables, and not inside an f-string.

    Before Python 3.12, `ast` reports wrong positions inside f-strings.
    """
    nodes = list(ast.walk(function))
    assigned_names = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    excluded_names = {node.arg for node in nodes if isinstance(node, ast.arg)}
    excluded_names |= {name for node in nodes if isinstance(node, ast.Global | ast.Nonlocal) for name in node.names}
    excluded_names |= {node.name for node in nodes if isinstance(node, ast.ExceptHandler) and node.name}
    for outer in (node for node in nodes if isinstance(node, ast.JoinedStr | ast.ClassDef)):
        excluded_names |= {node.id for node in ast.walk(outer) if isinstance(node, ast.Name)}
    return assigned_names - excluded_names


def _span_with_decorators(source: Source, function: Function) -> tuple[int, int]:
    start, end = source.span(function)
    for decorator in function.decorator_list[:1]:
        start = source.data.rindex(b"@", 0, source.span(decorator)[0])
    return start, end


def _end_of_header(source: Source, function: Function) -> int:
    """Return the offset of the colon before a function's body."""
    depth = 0
    for token in tokenize.tokenize(io.BytesIO(source.data).readline):
        if token.start >= (function.lineno, function.col_offset):
            depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(token.string, 0)
            if token.string == ":" and depth == 0:
                break
    return source.offset(*token.start)


REWRITINGS = (
    mirrored_comparisons,
    inverted_conditions,
    expanded_increments,
    renamed_variables,
    return_types,
    postponed_annotations,
    reordered_methods,
)
