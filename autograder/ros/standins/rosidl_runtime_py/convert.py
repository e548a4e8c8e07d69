"""Conversion of ROS messages to dictionaries, YAML and CSV (stand-in for `rosidl_runtime_py.convert`)."""

from __future__ import annotations

import array
import sys
from collections import OrderedDict
from typing import Any

import numpy as np
import yaml
from rosidl_parser.definition import (
    AbstractNestedType,
    AbstractString,
    AbstractWString,
    Array,
    BasicType,
    BoundedSequence,
    NamedType,
    NamespacedType,
)

_SEQUENCES = (list, tuple, array.array, np.ndarray)
_ELLIPSIS = "..."


class _MessageDumper(yaml.Dumper):
    """Writes an OrderedDict as a plain mapping, in the order of the message's fields."""


_MessageDumper.add_representer(
    OrderedDict,
    lambda dumper, data: dumper.represent_mapping("tag:yaml.org,2002:map", list(data.items()), flow_style=False),
)


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the type (of `rosidl_parser.definition`) of each field of a message, in the order of its definition."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Convert a message, and the messages inside it, to plain Python values.

    Args:
        msg: any ROS message.
        truncate_length: the maximum length of strings and arrays; longer ones are cut, and end with `...`.
        no_arr: whether to replace each array by a summary.
        no_str: whether to replace each string by a summary.
    """
    return OrderedDict(
        (name, _to_plain(getattr(msg, name), slot, truncate_length, no_arr, no_str))
        for name, slot in get_message_slot_types(msg).items()
    )


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Convert a message to YAML text; the arguments are those of `message_to_ordereddict`.

    `flow_style` writes lists in brackets, on one line.
    """
    values = message_to_ordereddict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    text: str = yaml.dump(
        values,
        Dumper=_MessageDumper,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=flow_style,
        sort_keys=False,
    )
    return text


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Convert a message to one line of comma-separated values, nested fields flattened.

    Values are not quoted, as in the real function: a string with a comma in it looks like two values.
    """
    return ",".join(
        _to_csv(getattr(msg, name), slot, truncate_length, no_arr, no_str)
        for name, slot in get_message_slot_types(msg).items()
    )


def _to_plain(value: Any, slot: Any, limit: int | None, no_arr: bool, no_str: bool) -> Any:
    if isinstance(value, bytes):
        return _truncate(value.decode("latin-1"), limit)
    if isinstance(value, str):
        return _string_summary(value) if no_str else _truncate(value, limit)
    if isinstance(value, _SEQUENCES):
        if no_arr and slot is not None:
            return _array_summary(value, slot)
        items = [_to_plain(item, None, limit, no_arr, no_str) for item in value[:limit]]
        return [*items, _ELLIPSIS] if limit is not None and len(value) > limit else items
    if isinstance(value, np.number):
        return value.item()
    if isinstance(value, (bool, int, float)):
        return value
    return message_to_ordereddict(value, truncate_length=limit, no_arr=no_arr, no_str=no_str)


def _to_csv(value: Any, slot: Any, limit: int | None, no_arr: bool, no_str: bool) -> str:
    if isinstance(value, _SEQUENCES):
        if no_arr and slot is not None:
            return _array_summary(value, slot)
        items = [_to_csv(item, None, limit, no_arr, no_str) for item in value[:limit]]
        return ",".join([*items, _ELLIPSIS] if limit is not None and len(value) > limit else items)
    if isinstance(value, bytes):
        return str(value if limit is None or len(value) <= limit else value[:limit] + b"...")
    if isinstance(value, str):
        return _string_summary(value) if no_str else _truncate(value, limit)
    if isinstance(value, (bool, int, float, np.number)):
        return str(value)
    return message_to_csv(value, truncate_length=limit, no_arr=no_arr, no_str=no_str)


def _truncate(text: str, limit: int | None) -> str:
    return text if limit is None or len(text) <= limit else text[:limit] + _ELLIPSIS


def _string_summary(text: str) -> str:
    return f"<string length: <{len(text)}>>"


def _array_summary(value: Any, slot: AbstractNestedType) -> str:
    name = _type_name(slot.value_type)
    if isinstance(slot, Array):
        return f"<array type: {name}[{slot.size}]>"
    if isinstance(slot, BoundedSequence):
        return f"<sequence type: {name}[{slot.maximum_size}], length: {len(value)}>"
    return f"<sequence type: {name}, length: {len(value)}>"


def _type_name(value_type: Any) -> str:
    if isinstance(value_type, BasicType):
        return str(value_type.typename)
    if isinstance(value_type, AbstractString):
        return "string"
    if isinstance(value_type, AbstractWString):
        return "wstring"
    if isinstance(value_type, NamespacedType):
        return "/".join(value_type.namespaced_name())
    if isinstance(value_type, NamedType):
        return str(value_type.name)
    return "unknown"
