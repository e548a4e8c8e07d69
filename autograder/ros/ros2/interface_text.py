"""The text of an interface as `ros2 interface show` prints it: nested messages unfolded below their fields."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

_PRIMITIVES = {
    "bool", "byte", "char", "float32", "float64", "string", "wstring",
    "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64",
}  # fmt: skip

# A field: its type without bounds and array brackets, then its name. A constant has `=` and is always primitive.
_FIELD = re.compile(r"\s*(?P<type>[A-Za-z][\w/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*\s*(?!=)")


def unfold(
    name: str, read: Callable[[str], str], *, comments: bool = True, nested_comments: bool = False, depth: int = 0
) -> Iterator[str]:
    """Yield the lines of an interface, each nested message's lines after its field, one tab deeper.

    Args:
        name: `package/kind/Name`.
        read: returns the definition of an interface, given its name.
        comments: keep comments and blank lines of the interface itself.
        nested_comments: keep those of the nested messages as well.
        depth: how many tabs to indent by.
    """
    for line in read(name).rstrip().splitlines():
        shown = line.rstrip() if comments else _without_comment(line)
        if comments or shown:
            yield "\t" * depth + shown if shown else ""
        inner = nested_type(line, name.split("/")[0])
        if inner:
            yield from unfold(inner, read, comments=nested_comments, nested_comments=nested_comments, depth=depth + 1)


def nested_type(line: str, package: str) -> str | None:
    """Return the full name of the message that a line's field holds, `None` for any other line."""
    field = _FIELD.match(_without_comment(line))
    if not field or field["type"] in _PRIMITIVES:
        return None
    parts = field["type"].split("/")
    if len(parts) == 1:
        return f"{package}/msg/{parts[0]}"
    return f"{parts[0]}/msg/{parts[-1]}"


def _without_comment(line: str) -> str:
    """Cut a comment off; a `#` inside a quoted default value does not begin one."""
    quote = ""
    for position, char in enumerate(line):
        if quote:
            quote = "" if char == quote else quote
        elif char in "\"'":
            quote = char
        elif char == "#":
            return line[:position].rstrip()
    return line.rstrip()
