"""Mutation operators for Python.

They change the text at the positions that `ast` reports, and leave the rest unchanged. cosmic-ray and mutmut have only
the classic operators, and depend on a parser and a dozen other packages. The ROS operators in `ros_operators.py` need
the positions from `ast` in any case.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

SYMBOLS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
SYMBOLS |= {ast.Is: "is", ast.IsNot: "is not", ast.In: "in", ast.NotIn: "not in"}
OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "is": "is not", "in": "not in"}
OPPOSITE |= {opposite: symbol for symbol, opposite in OPPOSITE.items()}
BOUNDARY = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
ARITHMETIC = {ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*")}
ARITHMETIC |= {ast.FloorDiv: ("//", "/"), ast.Mod: ("%", "//")}
LEVELS = {"debug": "info", "info": "debug", "warning": "info", "error": "warning", "fatal": "error"}
# Keyword arguments whose text only people read.
TEXT_ARGUMENTS = {"description", "additional_constraints", "reason", "msg", "maintainer", "maintainer_email"}
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)

Replacement = tuple[int, int, str]  # start and end of the replaced part in UTF-8 bytes, and the new text
Mutation = tuple[str, tuple[Replacement, ...]]  # the operator, and the replacements that it makes
NodeMutation = tuple[str, ast.AST, str]  # the operator, the replaced node, and the new text


class Source:
    """A module's source text, addressed by the nodes of its syntax tree."""

    def __init__(self, text: str) -> None:
        self.data = text.encode()
        self.tree = ast.parse(text)
        self._starts = [0]
        for line in self.data.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))

    def span(self, first: ast.AST, last: ast.AST | None = None) -> tuple[int, int]:
        """Return the start and end of a node, or of a range of nodes."""
        last = last or first
        end = self.offset(getattr(last, "end_lineno"), getattr(last, "end_col_offset"))  # noqa: B009
        return self.offset(getattr(first, "lineno"), getattr(first, "col_offset")), end  # noqa: B009

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a position in UTF-8 bytes. Lines start at 1, columns at 0."""
        return self._starts[line - 1] + column

    def text(self, node: ast.AST) -> str:
        """Return the text of a node."""
        start, end = self.span(node)
        return self.data[start:end].decode()


def replaced(data: bytes, changes: Iterable[Replacement]) -> bytes:
    """Return a text in which some parts, which must not overlap, are replaced."""
    for start, end, new in sorted(changes, reverse=True):
        data = data[:start] + new.encode() + data[end:]
    return data


@dataclass(frozen=True)
class NodeInContext:
    """A node, its ancestors (innermost first), and the function that contains it, or None."""

    node: ast.AST
    ancestors: tuple[ast.AST, ...]
    function: ast.FunctionDef | ast.AsyncFunctionDef | None


def nodes_in_context(source: Source, functions: frozenset[str] | None) -> Iterator[tuple[str, NodeInContext]]:
    """Yield (function name, node) for each node that students write. The name is "" at module level.

    Args:
        source: the module.
        functions: qualified names of the functions that students write; None means all.
    """

    def walk(node: ast.AST, name: str, context: NodeInContext) -> Iterator[tuple[str, NodeInContext]]:
        inner_context = NodeInContext(node, (context.node, *context.ancestors), context.function)
        if isinstance(node, (*FUNCTIONS, ast.ClassDef)):
            name = f"{name}.{node.name}".lstrip(".")
            function = node if isinstance(node, FUNCTIONS) else None
            inner_context = NodeInContext(node, inner_context.ancestors, function or context.function)
            if (
                function
                and functions is not None
                and not any(f"{name}.".startswith(f"{written_function}.") for written_function in functions)
            ):
                return
        elif _is_not_mutated(node, context):
            return
        yield name, inner_context
        for field, value in ast.iter_fields(node):
            if field not in ("annotation", "returns", "ctx"):
                for child in value if isinstance(value, list) else [value]:
                    if isinstance(child, ast.AST):
                        yield from walk(child, name, inner_context)

    for statement in source.tree.body:
        yield from walk(statement, "", NodeInContext(source.tree, (), None))


def _is_not_mutated(node: ast.AST, context: NodeInContext) -> bool:
    """Return whether a node does not affect execution, or contains only text for people."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return True  # a docstring
    if isinstance(node, ast.Import | ast.ImportFrom | ast.JoinedStr):
        return True
    if isinstance(node, ast.If) and "__name__" in ast.dump(node.test):
        return True
    if isinstance(node, ast.keyword) and node.arg in TEXT_ARGUMENTS:
        return True
    outer = context.node
    if isinstance(outer, ast.Call) and isinstance(outer.func, ast.Attribute) and outer.func.attr in LEVELS:
        return node in outer.args
    return isinstance(node, ast.Constant | ast.Call) and isinstance(outer, ast.Raise | ast.Assert)


def classic_mutations(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    """Yield the mutations of a node that do not depend on its context or on ROS."""
    for operator in _OPERATORS:
        yield from operator(source, node)


def _operators(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if isinstance(node, ast.Compare):
        operands = [source.text(operand) for operand in (node.left, *node.comparators)]
        for changed_index, old in enumerate(node.ops):
            for name, table in (("boundary", BOUNDARY), ("negated", OPPOSITE)):
                symbols = [SYMBOLS[type(op)] for op in node.ops]
                if (symbol := SYMBOLS[type(old)]) in table:
                    symbols[changed_index] = table[symbol]
                    pairs = (f" {symbol} {operand}" for symbol, operand in zip(symbols, operands[1:], strict=True))
                    yield name, node, f"({operands[0]}{''.join(pairs)})"
    elif isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC:
        new = ARITHMETIC[type(node.op)][1]
        yield "arithmetic", node, f"(({source.text(node.left)}) {new} ({source.text(node.right)}))"
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        yield "sign" if isinstance(node.op, ast.USub) else "negated", node, f"({source.text(node.operand)})"
    elif isinstance(node, ast.BoolOp):
        word = " or " if isinstance(node.op, ast.And) else " and "
        yield "boolean", node, f"({word.join(f'({source.text(value)})' for value in node.values)})"
        for removed_index in range(len(node.values)):
            operands = [f"({source.text(value)})" for index, value in enumerate(node.values) if index != removed_index]
            word = " and " if isinstance(node.op, ast.And) else " or "
            yield "boolean", node, f"({word.join(operands)})"


def _conditions(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if isinstance(node, ast.If | ast.IfExp):
        yield "condition", node.test, "True"
        yield "condition", node.test, "False"
    elif isinstance(node, ast.While):
        yield "condition", node.test, "False"
    elif isinstance(node, ast.For):
        yield "loop", node.iter, "()"
        yield "order", node.iter, f"reversed(list({source.text(node.iter)}))"
    elif isinstance(node, ast.comprehension):
        yield "order", node.iter, f"reversed(list({source.text(node.iter)}))"
        for test in node.ifs:
            yield "condition", test, "True"


def _constants(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if not isinstance(node, ast.Constant):
        return
    value = node.value
    if isinstance(value, bool):
        yield "constant", node, str(not value)
    elif isinstance(value, str) and " " not in value:  # a string with spaces is text, not a name
        yield "name", node, repr(f"{value}s" if value else "x")
    elif isinstance(value, int | float):
        yield from ((name, node, text) for name, text in numbers(value))


def numbers(value: float) -> Iterator[tuple[str, str]]:
    """Yield (operator, new text) for a number: one more, one less, 10 % more, 25 % less, and the opposite sign."""
    is_integer = isinstance(value, int)
    new_texts = {repr(value): ""}
    neighbours = [("off by one", value + 1), ("off by one", value - 1)] if is_integer or value == 0 else []
    for name, new in (*neighbours, ("10 %", value * 1.1), ("25 %", value * 0.75), ("sign", -value)):
        text = repr(round(new) if is_integer else float(f"{new:.6g}"))
        if text not in new_texts and text != "-0.0":
            new_texts[text] = name
            yield name, f"({text})" if text.startswith("-") else text


def _statements(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield f"no {_kind(node.value)}", node, "pass"
    elif isinstance(node, ast.Assign | ast.AugAssign):
        target = node.targets[0] if isinstance(node, ast.Assign) else node.target
        owner = getattr(getattr(target, "value", None), "id", "self")
        is_field = isinstance(target, ast.Attribute) and (owner != "self" or isinstance(target.value, ast.Attribute))
        yield "no field" if is_field else "no assignment", node, "pass"
    elif isinstance(node, ast.Return):
        yield "no return", node, "return None" if node.value else "pass"
    elif isinstance(node, ast.Raise | ast.Assert | ast.Break | ast.Continue | ast.Delete):
        yield f"no {type(node).__name__.lower()}", node, "pass"
        if isinstance(node, ast.Break | ast.Continue):
            yield "loop", node, "continue" if isinstance(node, ast.Break) else "break"


def _kind(call: ast.Call) -> str:
    """Return the kind of a call: "log", "publish", "timer" or "call"."""
    name = getattr(call.func, "attr", "")
    return {"publish": "publish", "create_timer": "timer"}.get(name, "log" if name in LEVELS else "call")


def _arguments(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if not isinstance(node, ast.Call):
        return
    positional = [source.text(argument) for argument in node.args]
    keywords = [
        f"{keyword.arg}={source.text(keyword.value)}" if keyword.arg else f"**{source.text(keyword.value)}"
        for keyword in node.keywords
    ]
    function = source.text(node.func)
    if isinstance(node.func, ast.Attribute) and node.func.attr in LEVELS:
        level = f"{source.text(node.func.value)}.{LEVELS[node.func.attr]}"
        yield "log level", node, f"{level}({', '.join(positional + keywords)})"
    elif not any(isinstance(argument, ast.Starred) for argument in node.args):
        for index in range(len(positional) - 1):
            swapped_arguments = [
                *positional[:index],
                positional[index + 1],
                positional[index],
                *positional[index + 2 :],
            ]
            yield "arguments", node, f"{function}({', '.join(swapped_arguments + keywords)})"


def _elements(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if isinstance(node, ast.Tuple) and isinstance(node.ctx, ast.Load):
        elements = [source.text(element) for element in node.elts]
        for index in range(len(elements)):
            remaining_elements = "".join(f"{element}, " for element in elements[:index] + elements[index + 1 :])
            yield "element", node, f"({remaining_elements})"


def removal_mutations(source: Source, node: ast.AST) -> Iterator[Mutation]:
    """Yield mutations that remove a keyword argument, or an element of a list or dictionary."""
    parts: list[tuple[ast.AST, ast.AST]] = []
    if isinstance(node, ast.Call):
        arguments: list[ast.expr | ast.keyword] = [*node.args, *node.keywords]
        arguments.sort(key=lambda argument: (argument.lineno, argument.col_offset))
        parts = [(argument, argument) for argument in arguments]
    elif isinstance(node, ast.List):
        parts = [(element, element) for element in node.elts]
    elif isinstance(node, ast.Dict) and None not in node.keys:
        parts = [(key, value) for key, value in zip(node.keys, node.values, strict=True) if key is not None]
    spans = [source.span(*part) for part in parts]
    for index, ((part, _), (start, end)) in enumerate(zip(parts, spans, strict=True)):
        if isinstance(node, ast.Call) and (not isinstance(part, ast.keyword) or part.arg in TEXT_ARGUMENTS):
            continue
        if index + 1 < len(parts):
            end = spans[index + 1][0]
        elif index:
            start = spans[index - 1][1]
        else:
            end = source.span(node)[1] - 1  # includes a trailing comma
        yield "keyword" if isinstance(node, ast.Call) else "element", ((start, end, ""),)


def _exceptions(source: Source, node: ast.AST) -> Iterator[NodeMutation]:
    if isinstance(node, ast.ExceptHandler) and node.type is not None and source.text(node.type) != "Exception":
        yield "exception", node.type, "Exception"


_OPERATORS: Sequence[Callable[[Source, ast.AST], Iterator[NodeMutation]]] = (
    _operators,
    _conditions,
    _constants,
    _statements,
    _arguments,
    _elements,
    _exceptions,
)
