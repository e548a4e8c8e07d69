"""Mutation operators. Each changes a Python source at one place, like a slip of a student.

They change the text at the positions that `ast` gives, so that the rest of the text stays the same.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

SYMBOLS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
SYMBOLS |= {ast.Is: "is", ast.IsNot: "is not", ast.In: "in", ast.NotIn: "not in"}
OPPOSITE = {"<": ">=", "<=": "<", ">": "<=", ">=": ">", "==": "!=", "!=": "==", "is": "is not", "is not": "is"}
OPPOSITE |= {"in": "not in", "not in": "in"}
ARITHMETIC = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}
ENDPOINTS = {"create_publisher": 1, "create_subscription": 1, "create_service": 1, "create_client": 1}
SWAPPED = {"min": "max", "max": "min", "any": "all", "all": "any", "ceil": "floor", "floor": "ceil"}
CALLS_FOR_PEOPLE = {"debug", "info", "warning", "error", "fatal", "ParameterDescriptor"}  # no check reads their texts


@dataclass(frozen=True)
class Change:
    """A change of a text.

    Attributes:
        operator: name of the mutation operator.
        function: qualified name of the changed function.
        start: offset of the replaced part, in characters.
        end: offset of its end, in characters.
        replacement: the new text.
    """

    operator: str
    function: str
    start: int
    end: int
    replacement: str

    def apply(self, text: str) -> str:
        """Return the changed text."""
        return text[: self.start] + self.replacement + text[self.end :]


def changes(text: str, functions: frozenset[str] | None = None) -> list[Change]:
    """Return every change that the operators make of a source, in the order of the text.

    Args:
        text: source of a module.
        functions: qualified names of the functions to change. None changes all but `main`.
    """
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    found = [
        Change(operator, name, _offset(text, starts, place, False), _offset(text, starts, place, True), replacement)
        for name, function in _functions(ast.parse(text))
        if (name in functions if functions is not None else name != "main")
        for node in _own_nodes(function)
        for operator, place, replacement in _mutations(node, text)
    ]
    return sorted(found, key=lambda change: (change.start, change.operator))


def _mutations(node: ast.AST, text: str) -> Iterator[tuple[str, ast.AST, str]]:
    """Yield (operator, node to replace, new text)."""
    if isinstance(node, ast.Compare):
        yield from _comparisons(node, text)
    elif isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC:
        yield "sign", node, f"({_text(text, node.left)} {ARITHMETIC[type(node.op)]} {_text(text, node.right)})"
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield "sign", node, _text(text, node.operand)
    elif isinstance(node, ast.BoolOp):
        word = " or " if isinstance(node.op, ast.And) else " and "
        yield "boolean", node, word.join(_text(text, value) for value in node.values)
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        yield "constant", node, "1" if node.value == 0 else repr(node.value * 2)
    elif isinstance(node, ast.Name) and node.id == "qos_profile_sensor_data":
        yield "qos", node, "10"
    elif isinstance(node, ast.Call):
        yield from _calls(node, text)
    elif (
        isinstance(node, ast.If) and not node.orelse and isinstance(node.body[-1], ast.Return | ast.Continue | ast.Pass)
    ):
        yield "guard", node.test, "False"


def _comparisons(node: ast.Compare, text: str) -> Iterator[tuple[str, ast.AST, str]]:
    """Yield the comparison once for each of its operators, with that operator inverted."""
    operands = [_text(text, operand) for operand in (node.left, *node.comparators)]
    for changed in range(len(node.ops)):
        symbols = [SYMBOLS[type(op)] for op in node.ops]
        symbols[changed] = OPPOSITE[symbols[changed]]
        rest = (f" {symbol} {operand}" for symbol, operand in zip(symbols, operands[1:], strict=True))
        yield "compare", node, operands[0] + "".join(rest)


def _calls(node: ast.Call, text: str) -> Iterator[tuple[str, ast.AST, str]]:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    if name in ENDPOINTS and len(node.args) > 1 and isinstance(node.args[1], ast.Constant):
        yield "topic", node.args[1], repr(f"{node.args[1].value!s}s")
    if name in SWAPPED:
        yield "order", node.func, _text(text, node.func)[: -len(name)] + SWAPPED[name]
    if name in ("radians", "degrees") and len(node.args) == 1:
        yield "units", node, _text(text, node.args[0])


def _own_nodes(function: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a function's body, without docstrings, nested functions and log calls."""
    pending = list(ast.iter_child_nodes(function))
    while pending:
        node = pending.pop(0)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            continue  # a docstring
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.arguments):
            continue
        if isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) in CALLS_FOR_PEOPLE:
            continue
        yield node
        pending = [*ast.iter_child_nodes(node), *pending]


def _functions(tree: ast.AST, prefix: str = "") -> Iterator[tuple[str, ast.AST]]:
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ClassDef):
            yield from _functions(node, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield f"{prefix}{node.name}", node
            yield from _functions(node, f"{prefix}{node.name}.")


def _text(text: str, node: ast.AST) -> str:
    return ast.get_source_segment(text, node) or ""


def _offset(text: str, starts: list[int], node: ast.AST, end: bool) -> int:
    """Return the offset of a node's start or end in characters; `ast` counts columns in bytes of UTF-8."""
    line: int = getattr(node, "end_lineno" if end else "lineno")
    column: int = getattr(node, "end_col_offset" if end else "col_offset")
    whole = text[starts[line - 1] : starts[line]]
    return starts[line - 1] + len(whole.encode()[:column].decode())
