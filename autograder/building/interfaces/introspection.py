"""Descriptions of types for rmw_fastrtps_cpp, which tells Fast DDS of them: rosidl's C structures, made at run time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from ctypes import (
    CDLL,
    POINTER,
    Structure,
    addressof,
    c_bool,
    c_char_p,
    c_size_t,
    c_uint8,
    c_uint32,
    c_void_p,
    cast,
    pointer,
)
from functools import cache
from typing import Any

from rosidl_parser import definition as rosidl

IDENTIFIER = b"rosidl_typesupport_introspection_c"
_IDS = {
    **{"float": 1, "double": 2, "boolean": 6, "octet": 7, "uint8": 8, "int8": 9, "uint16": 10, "int16": 11},
    **{"uint32": 12, "int32": 13, "uint64": 14, "int64": 15},
}
_TEXT, _WIDE_TEXT, _MESSAGE = 16, 17, 18

Members = Callable[[rosidl.NamespacedType], Sequence[tuple[str, rosidl.AbstractType]]]
"""Returns the names and types of a message's members."""


class MessageSupport(Structure):
    """C's `rosidl_message_type_support_t`."""

    _fields_ = (
        *(("identifier", c_void_p), ("data", c_void_p), ("handle", c_void_p), ("hash", c_void_p)),
        *(("description", c_void_p), ("sources", c_void_p)),
    )


class _Member(Structure):  # rosidl_typesupport_introspection_c__MessageMember
    _fields_ = (
        *(("name", c_char_p), ("type_id", c_uint8), ("max_length", c_size_t), ("members", POINTER(MessageSupport))),
        *(("is_key", c_bool), ("is_array", c_bool), ("size", c_size_t), ("at_most", c_bool), ("offset", c_uint32)),
        *((name, c_void_p) for name in ("default", "count", "get_const", "get", "fetch", "assign", "resize")),
    )


class _Members(Structure):  # rosidl_typesupport_introspection_c__MessageMembers
    _fields_ = (
        *(("namespace", c_char_p), ("name", c_char_p), ("count", c_uint32), ("size", c_size_t)),
        *(("has_key", c_bool), ("members", POINTER(_Member)), ("initialize", c_void_p), ("finalize", c_void_p)),
    )


@cache
def _constants() -> tuple[int | None, int | None]:
    """Return the address of the type support's name, which is compared by address, and that of its handle function."""
    name = c_void_p.in_dll(CDLL("librosidl_typesupport_introspection_c.so"), f"{IDENTIFIER.decode()}__identifier")
    handle = CDLL("librosidl_runtime_c.so")["get_message_typesupport_handle_function"]
    return name.value, cast(handle, c_void_p).value


_keep: list[Any] = []  # objects that C code points to, for the lifetime of the process


class Introspection:
    """The structures of types, each made once."""

    def __init__(self, members: Members) -> None:
        self._members = members
        self._made: dict[tuple[str, ...], MessageSupport] = {}

    def support(self, kind: rosidl.NamespacedType) -> MessageSupport:
        """Return the structure of a message's type."""
        name = kind.namespaced_name()
        if name not in self._made:
            members = [self._member(name, inner) for name, inner in self._members(kind)]
            array = (_Member * len(members))(*members)
            namespace, own = "__".join(kind.namespaces).encode(), kind.name.encode()
            described = _Members(namespace, own, len(members), 0, False, array, None, None)
            self._made[name] = MessageSupport(*_constants()[:1], addressof(described), *_constants()[1:])
            _keep.extend((array, described, self._made[name]))
        return self._made[name]

    def _member(self, name: str, kind: rosidl.AbstractType) -> _Member:
        value: Any = kind.value_type if isinstance(kind, rosidl.AbstractNestedType) else kind
        member = _Member(name=name.encode(), is_array=value is not kind)
        if isinstance(value, rosidl.NamespacedType):
            member.type_id, member.members = _MESSAGE, pointer(self.support(value))
        elif isinstance(value, rosidl.AbstractGenericString):
            member.type_id = _WIDE_TEXT if isinstance(value, rosidl.AbstractWString) else _TEXT
            member.max_length = value.maximum_size if value.has_maximum_size() else 0
        else:
            member.type_id = _IDS[value.typename]
        if isinstance(kind, rosidl.Array):
            member.size = kind.size
        elif isinstance(kind, rosidl.BoundedSequence):
            member.size, member.at_most = kind.maximum_size, True
        return member
