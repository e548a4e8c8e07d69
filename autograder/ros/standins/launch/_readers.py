"""The functions that read an action's arguments from an XML or YAML launch file, one for each class of actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .frontend import Entity, Parser

Reader = Callable[["Entity", "Parser"], dict[str, Any]]

# For each class of actions, the function that returns its keyword arguments, except the condition.
READERS: dict[type, Reader] = {}


def reader_of(action: type) -> Callable[[Reader], Reader]:
    """Return the decorator that makes a function the reader of a class of actions."""

    def register(reader: Reader) -> Reader:
        READERS[action] = reader
        return reader

    return register
