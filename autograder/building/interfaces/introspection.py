"""Describes types at run time in rosidl's C structures, which rmw_fastrtps_cpp passes to Fast DDS."""

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
_STRING, _WIDE_STRING, _MESSAGE = 16, 17, 18

Members = Callable[[rosidl.NamespacedType], Sequence[tuple[str, rosidl.AbstractType]]]
"""Returns the names and types of a message's members."""


class MessageSupport(Structure):
    """The C structure `rosidl_message_type_support_t`."""

    _fields_ = (
        *(("identifier", c_void_p), ("data", c_void_p), ("handle", c_void_p), ("hash", c_void_p)),
        *(("description", c_void_p), ("sources", c_void_p)),
    )


class _Member(Structure):  # rosidl_typesupport_introspection_c__MessageMember
    _fields_ = (
        *(("name", c_char_p), ("type_id", c_uint8), ("max_length", c_size_t), ("members", POINTER(MessageSupport))),
        *(
            ("is_key", c_bool),
            ("is_array", c_bool),
            ("size", c_size_t),
            ("is_upper_bound", c_bool),
            ("offset", c_uint32),
        ),
        *((name, c_void_p) for name in ("default", "count", "get_const", "get", "fetch", "assign", "resize")),
    )


class _Members(Structure):  # rosidl_typesupport_introspection_c__MessageMembers
    _fields_ = (
        *(("namespace", c_char_p), ("name", c_char_p), ("count", c_uint32), ("size", c_size_t)),
        *(("has_key", c_bool), ("members", POINTER(_Member)), ("initialize", c_void_p), ("finalize", c_void_p)),
    )


@cache
def _common_addresses() -> tuple[int | None, int | None]:
    """Return the addresses of the type support's name, which is compared by address, and of its handle function."""
    name = c_void_p.in_dll(CDLL("librosidl_typesupport_introspection_c.so"), f"{IDENTIFIER.decode()}__identifier")
    handle = CDLL("librosidl_runtime_c.so")["get_message_typesupport_handle_function"]
    return name.value, cast(handle, c_void_p).value


_kept_alive: list[Any] = []  # objects that C code refers to until the process ends


class Introspection:
    """Creates the structures that describe types, and caches them."""

    def __init__(self, members: Members) -> None:
        self._members = members
        self._supports: dict[tuple[str, ...], MessageSupport] = {}

    def support(self, kind: rosidl.NamespacedType) -> MessageSupport:
        """Return the structure that describes a message's type."""
        name = kind.namespaced_name()
        if name not in self._supports:
            members = [self._member(name, inner) for name, inner in self._members(kind)]
            array = (_Member * len(members))(*members)
            namespace = "__".join(kind.namespaces).encode()
            structure = _Members(namespace, kind.name.encode(), len(members), 0, False, array, None, None)
            self._supports[name] = MessageSupport(
                *_common_addresses()[:1], addressof(structure), *_common_addresses()[1:]
            )
            _kept_alive.extend((array, structure, self._supports[name]))
        return self._supports[name]

    def _member(self, name: str, kind: rosidl.AbstractType) -> _Member:
        value: Any = kind.value_type if isinstance(kind, rosidl.AbstractNestedType) else kind
        member = _Member(name=name.encode(), is_array=value is not kind)
        if isinstance(value, rosidl.NamespacedType):
            member.type_id, member.members = _MESSAGE, pointer(self.support(value))
        elif isinstance(value, rosidl.AbstractGenericString):
            member.type_id = _WIDE_STRING if isinstance(value, rosidl.AbstractWString) else _STRING
            member.max_length = value.maximum_size if value.has_maximum_size() else 0
        else:
            member.type_id = _IDS[value.typename]
        if isinstance(kind, rosidl.Array):
            member.size = kind.size
        elif isinstance(kind, rosidl.BoundedSequence):
            member.size, member.is_upper_bound = kind.maximum_size, True
        return member
