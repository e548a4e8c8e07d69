"""The text of an interface as `ros2 interface show` prints it: nested messages are expanded below their fields."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

_PRIMITIVES = {
    "bool", "byte", "char", "float32", "float64", "string", "wstring",
    "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64",
}  # fmt: skip

# A field: its type without bounds and array brackets, then its name. A constant has `=` and is always primitive.
_FIELD = re.compile(r"\s*(?P<type>[A-Za-z][\w/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*\s*(?!=)")


def expand_lines(
    name: str, read: Callable[[str], str], *, comments: bool = True, nested_comments: bool = False, depth: int = 0
) -> Iterator[str]:
    """Yield the lines of an interface. The lines of a nested message follow its field, indented by one more tab.

    Args:
        name: `package/kind/Name`.
        read: a function that takes the name of an interface and returns its definition.
        comments: whether to keep comments and blank lines of the interface itself.
        nested_comments: whether to keep comments and blank lines of nested messages.
        depth: the number of tabs that indent the lines.
    """
    for line in read(name).rstrip().splitlines():
        text = line.rstrip() if comments else _without_comment(line)
        if comments or text:
            yield "\t" * depth + text if text else ""
        nested_name = nested_type(line, name.split("/")[0])
        if nested_name:
            yield from expand_lines(
                nested_name, read, comments=nested_comments, nested_comments=nested_comments, depth=depth + 1
            )


def nested_type(line: str, package: str) -> str | None:
    """Return the full name of the message type of a line's field, or `None` for any other line."""
    field = _FIELD.match(_without_comment(line))
    if not field or field["type"] in _PRIMITIVES:
        return None
    parts = field["type"].split("/")
    if len(parts) == 1:
        return f"{package}/msg/{parts[0]}"
    return f"{parts[0]}/msg/{parts[-1]}"


def _without_comment(line: str) -> str:
    """Remove a line's comment. A `#` inside a quoted default value does not begin a comment."""
    quote = ""
    for position, char in enumerate(line):
        if quote:
            quote = "" if char == quote else quote
        elif char in "\"'":
            quote = char
        elif char == "#":
            return line[:position].rstrip()
    return line.rstrip()
