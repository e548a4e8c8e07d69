"""Converts plain values to and from CDR, the format of DDS messages, according to rosidl's model of their types.

The bytes are untrusted. Reading is bounded, and bytes that do not match the type raise a ValueError.
"""

from __future__ import annotations

import array
import struct
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from rosidl_parser import definition as rosidl

MAX_BYTES = 256 * 1024  # of a message
MAX_OBJECTS = 10_000  # strings and nested messages in a message
CODES = {  # format characters of `struct`; those of numbers are also type codes of `array`
    **{"boolean": "?", "octet": "c", "float": "f", "double": "d"},
    **{
        "int8": "b",
        "uint8": "B",
        "int16": "h",
        "uint16": "H",
        "int32": "i",
        "uint32": "I",
        "int64": "q",
        "uint64": "Q",
    },
}
NUMBERS = frozenset(CODES) - {"boolean", "octet"}

Members = Callable[[rosidl.NamespacedType], Sequence[tuple[str, rosidl.AbstractType]]]
"""Returns the names and types of a message's members."""

Make = Callable[[rosidl.NamespacedType, dict[str, Any]], Any]
"""Creates a message from the values of its members."""


class Writer:
    """Writes values to `data`, little-endian; `members` returns the members of nested messages.

    Raises:
        ValueError: a value does not match its type.
    """

    def __init__(self, members: Members) -> None:
        self.data = bytearray()
        self._members = members

    def write(self, kind: rosidl.AbstractType, value: Any) -> None:
        """Write a value of a type."""
        try:
            self._write(kind, value)
        except (struct.error, TypeError, OverflowError, AttributeError, UnicodeError) as error:
            raise ValueError(str(error)) from None

    def _write(self, kind: rosidl.AbstractType, value: Any) -> None:
        if isinstance(kind, rosidl.AbstractNestedType):
            self._write_elements(kind, value)
        elif isinstance(kind, rosidl.NamespacedType):
            for name, inner in self._members(kind):
                self._write(inner, getattr(value, name, 0))  # the member of an empty structure is 0
        elif isinstance(kind, rosidl.AbstractGenericString):
            if kind.has_maximum_size() and len(value) > kind.maximum_size:
                raise ValueError(f"more than {kind.maximum_size} characters")
            if isinstance(kind, rosidl.AbstractWString):
                text = _convert_units(value.encode("utf-16-le"), "H", "I")
                self._pack("I", len(text) // 4)
            else:
                text = value.encode() + b"\0"
                self._pack("I", len(text))
            self.data += text
        else:
            self._pack(CODES[kind.typename], value)

    def _write_elements(self, kind: Any, values: Any) -> None:
        if isinstance(kind, rosidl.Array):
            if len(values) != kind.size:
                raise ValueError(f"{len(values)} elements instead of {kind.size}")
        else:
            if kind.has_maximum_size() and len(values) > kind.maximum_size:
                raise ValueError(f"more than {kind.maximum_size} elements")
            self._pack("I", len(values))
        for value in values:
            self._write(kind.value_type, value)

    def _pack(self, code: str, value: Any) -> None:
        self.data += bytes(-len(self.data) % struct.calcsize(code)) + struct.pack(f"<{code}", value)


class Reader:
    """Reads values from bytes; `members` returns the members of nested messages, and `make` creates the messages.

    Raises:
        ValueError: there are too many bytes, or they do not match the type.
    """

    def __init__(self, data: bytes, members: Members, make: Make) -> None:
        if len(data) > MAX_BYTES:
            raise ValueError(f"more than {MAX_BYTES // 1024} KiB")
        self._data, self._offset, self._objects = data, 0, 0
        self._members, self._make = members, make

    def read(self, kind: rosidl.AbstractType) -> Any:
        """Read a value of a type."""
        if isinstance(kind, rosidl.AbstractNestedType):
            return self._read_elements(kind)
        if isinstance(kind, rosidl.BasicType):
            return struct.unpack(f"<{CODES[kind.typename]}", self._take(1, struct.calcsize(CODES[kind.typename])))[0]
        self._objects += 1
        if self._objects > MAX_OBJECTS:
            raise ValueError(f"more than {MAX_OBJECTS} strings and messages")
        if isinstance(kind, rosidl.NamespacedType):
            return self._make(kind, {name: self.read(inner) for name, inner in self._members(kind)})
        count = self._count()
        if isinstance(kind, rosidl.AbstractWString):
            return _convert_units(self._take(count, 4), "I", "H").decode("utf-16-le", "replace")
        return self._take(count, 1)[:-1].decode("utf-8", "replace")  # like rosidl, without a check of the length

    def _read_elements(self, kind: Any) -> Any:
        inner, is_array = kind.value_type, isinstance(kind, rosidl.Array)
        count = kind.size if is_array else self._count()
        if isinstance(kind, rosidl.BoundedSequence) and count > kind.maximum_size:
            raise ValueError("the sequence is too long")
        if not isinstance(inner, rosidl.BasicType) or inner.typename not in NUMBERS:
            return [self.read(inner) for _ in range(min(count, MAX_BYTES + 1))]
        code = CODES[inner.typename]
        data = self._take(count, struct.calcsize(code)) if count else b""
        return np.frombuffer(data, np.dtype(code).str).copy() if is_array else array.array(code, data)

    def _count(self) -> int:
        return int(struct.unpack("<I", self._take(1, 4))[0])

    def _take(self, count: int, size: int) -> bytes:
        start = self._offset + -self._offset % size
        self._offset = start + count * size
        if self._offset > len(self._data):
            raise ValueError("the bytes end too early")
        return self._data[start : self._offset]


def _convert_units(text: bytes, code: str, target_code: str) -> bytes:
    """Convert the units of a wide string to another size: Fast CDR writes the 16 bits of a unit as 32."""
    units = struct.unpack(f"<{len(text) // struct.calcsize(code)}{code}", text)
    return struct.pack(f"<{len(units)}{target_code}", *(unit & 0xFFFF for unit in units))
