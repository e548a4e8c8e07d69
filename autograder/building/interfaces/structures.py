"""Converts parsed definitions to rosidl's model of types: structures with members, including those of actions."""

from __future__ import annotations

from pathlib import PurePosixPath

from rosidl_parser import definition as rosidl

from autograder.building.interfaces.definitions import Definition, Field, Section

EMPTY = rosidl.Member(rosidl.BasicType("uint8"), "structure_needs_at_least_one_member")  # DDS allows no empty structure
_SUFFIXES = {"srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
_BASIC = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}


def model(package: str, definition: Definition) -> rosidl.Message | rosidl.Service | rosidl.Action:
    """Return rosidl's model of a definition of a package."""
    path = PurePosixPath(definition.path)
    kind, name = path.parts[0], path.stem
    suffixes = _SUFFIXES.get(kind, ("",))
    messages = [
        rosidl.Message(_structure(rosidl.NamespacedType([package, kind], f"{name}{suffix}"), section))
        for suffix, section in zip(suffixes, definition.sections, strict=True)
    ]
    if kind == "msg":
        return messages[0]
    return (rosidl.Service if kind == "srv" else rosidl.Action)(rosidl.NamespacedType([package, kind], name), *messages)


def type_of(field: Field) -> rosidl.AbstractType:
    """Return rosidl's model of a field's type."""
    value: rosidl.AbstractNestableType
    if field.package is not None:
        value = rosidl.NamespacedType([field.package, "msg"], field.base)
    elif field.base in ("string", "wstring"):
        wide = "W" if field.base == "wstring" else ""
        bounded = field.max_length is not None
        kind = getattr(rosidl, f"{'Bounded' if bounded else 'Unbounded'}{wide}String")
        value = kind(field.max_length) if bounded else kind()
    else:
        value = rosidl.BasicType(_BASIC.get(field.base, field.base))
    if not field.is_array:
        return value
    if field.size is None:
        return rosidl.UnboundedSequence(value)
    return (rosidl.BoundedSequence if field.is_upper_bound else rosidl.Array)(value, field.size)


def _structure(name: rosidl.NamespacedType, section: Section) -> rosidl.Structure:
    return rosidl.Structure(name, [rosidl.Member(type_of(field), field.name) for field in section.fields] or [EMPTY])


def describe(kind: rosidl.AbstractType) -> str:
    """Return the name of a field's type as in `get_fields_and_field_types` of rosidl's Python classes."""
    value = kind.value_type if isinstance(kind, rosidl.AbstractNestedType) else kind
    if isinstance(value, rosidl.NamespacedType):
        text = f"{value.namespaces[0]}/{value.name}"
    elif isinstance(value, rosidl.AbstractGenericString):
        text = "wstring" if isinstance(value, rosidl.AbstractWString) else "string"
        text += f"<{value.maximum_size}>" if value.has_maximum_size() else ""
    else:
        text = value.typename
    if isinstance(kind, rosidl.Array):
        return f"{text}[{kind.size}]"
    if isinstance(kind, rosidl.AbstractSequence):
        return f"sequence<{text}{f', {kind.maximum_size}' if kind.has_maximum_size() else ''}>"
    return text
