"""The types that messages of a student's packages may hold: the student's own, and those of ROS's packages."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any

from rosidl_generator_type_description import (
    add_action,
    add_msg,
    add_srv,
    calculate_type_hash,
    extract_full_type_description,
    serialize_individual_type_description,
)
from rosidl_parser import definition as rosidl

from autograder.building.interfaces.introspection import Introspection
from autograder.building.interfaces.structures import EMPTY

_ADD = {rosidl.Message: add_msg, rosidl.Service: add_srv, rosidl.Action: add_action}


class KnownTypes:
    """Classes and descriptions of types, by their names.

    Attributes:
        introspection: their descriptions in C.
    """

    def __init__(self) -> None:
        self._own: dict[tuple[str, ...], Any] = {}
        self._descriptions: dict[str, dict[str, Any]] = {}
        self.introspection = Introspection(self.members)

    def add(self, kind: rosidl.NamespacedType, made: Any) -> None:
        """Add the class of a student's message."""
        self._own[kind.namespaced_name()] = made

    def members(self, kind: rosidl.NamespacedType) -> list[tuple[str, rosidl.AbstractType]]:
        """Return the names and types of a message's members."""
        own = self._own.get(kind.namespaced_name())
        if own is not None:
            return list(own._members.items())
        real = _real(kind)
        return list(zip(real.get_fields_and_field_types(), real.SLOT_TYPES, strict=True)) or [(EMPTY.name, EMPTY.type)]

    def make(self, kind: rosidl.NamespacedType, values: Mapping[str, Any] | None = None) -> Any:
        """Make a message, of the values of all members where they are given."""
        own = self._own.get(kind.namespaced_name())
        if own is not None:
            return own() if values is None else own._of(values)
        real = _real(kind)
        return real(**{name: value for name, value in (values or {}).items() if name != EMPTY.name})

    def describe(self, models: Iterable[Any]) -> None:
        """Add the descriptions of a package's messages, services and actions, and of all that they hold."""
        described: dict[str, Any] = {}
        for model in models:
            _ADD[type(model)](model, described)
        for name, each in described.items():
            self._descriptions[name] = serialize_individual_type_description(each.namespaced_type, each.members)
        for each in described.values():
            self._describe_below(member.type for member in each.members)

    def hash(self, kind: rosidl.NamespacedType) -> str:
        """Return a type's hash, as rosidl would have it: `RIHS01_` and 64 hexadecimal digits."""
        name = "/".join(kind.namespaced_name())
        return str(calculate_type_hash(extract_full_type_description(name, self._descriptions)))

    def _describe_below(self, kinds: Iterable[rosidl.AbstractType]) -> None:
        for kind in kinds:
            value = kind.value_type if isinstance(kind, rosidl.AbstractNestedType) else kind
            if not isinstance(value, rosidl.NamespacedType) or "/".join(value.namespaced_name()) in self._descriptions:
                continue
            members = [rosidl.Member(inner, name) for name, inner in self.members(value)]
            self._descriptions["/".join(value.namespaced_name())] = serialize_individual_type_description(
                value, members
            )
            self._describe_below(member.type for member in members)


def _real(kind: rosidl.NamespacedType) -> Any:
    """Return the class of a message of one of ROS's packages."""
    return getattr(import_module(".".join(kind.namespaces)), kind.name)
