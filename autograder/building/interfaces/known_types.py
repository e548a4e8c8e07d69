"""The types that messages of a student's packages may contain: the packages' own types, and those of ROS."""

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
        introspection: their descriptions as C structures.
    """

    def __init__(self) -> None:
        self._student_classes: dict[tuple[str, ...], Any] = {}
        self._descriptions: dict[str, dict[str, Any]] = {}
        self.introspection = Introspection(self.members)

    def add(self, kind: rosidl.NamespacedType, message_class: Any) -> None:
        """Add the class of a student's message."""
        self._student_classes[kind.namespaced_name()] = message_class

    def members(self, kind: rosidl.NamespacedType) -> list[tuple[str, rosidl.AbstractType]]:
        """Return the names and types of a message's members."""
        student_class = self._student_classes.get(kind.namespaced_name())
        if student_class is not None:
            return list(student_class._members.items())
        ros_class = _ros_class(kind)
        return list(zip(ros_class.get_fields_and_field_types(), ros_class.SLOT_TYPES, strict=True)) or [
            (EMPTY.name, EMPTY.type)
        ]

    def make(self, kind: rosidl.NamespacedType, values: Mapping[str, Any] | None = None) -> Any:
        """Create a message, with the values of all members if they are given."""
        student_class = self._student_classes.get(kind.namespaced_name())
        if student_class is not None:
            return student_class() if values is None else student_class._from_values(values)
        ros_class = _ros_class(kind)
        return ros_class(**{name: value for name, value in (values or {}).items() if name != EMPTY.name})

    def describe(self, models: Iterable[Any]) -> None:
        """Add the descriptions of a package's messages, services and actions, and of all types that they contain."""
        structures: dict[str, Any] = {}
        for model in models:
            _ADD[type(model)](model, structures)
        for name, structure in structures.items():
            self._descriptions[name] = serialize_individual_type_description(
                structure.namespaced_type, structure.members
            )
        for structure in structures.values():
            self._describe_members(member.type for member in structure.members)

    def hash(self, kind: rosidl.NamespacedType) -> str:
        """Return a type's hash as rosidl computes it: `RIHS01_` and 64 hexadecimal digits."""
        name = "/".join(kind.namespaced_name())
        return str(calculate_type_hash(extract_full_type_description(name, self._descriptions)))

    def _describe_members(self, kinds: Iterable[rosidl.AbstractType]) -> None:
        for kind in kinds:
            value = kind.value_type if isinstance(kind, rosidl.AbstractNestedType) else kind
            if not isinstance(value, rosidl.NamespacedType) or "/".join(value.namespaced_name()) in self._descriptions:
                continue
            members = [rosidl.Member(inner, name) for name, inner in self.members(value)]
            self._descriptions["/".join(value.namespaced_name())] = serialize_individual_type_description(
                value, members
            )
            self._describe_members(member.type for member in members)


def _ros_class(kind: rosidl.NamespacedType) -> Any:
    """Return the class of a ROS package's message."""
    return getattr(import_module(".".join(kind.namespaces)), kind.name)
