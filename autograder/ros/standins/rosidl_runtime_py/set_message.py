"""Setting the fields of a message from a dictionary (stand-in for `rosidl_runtime_py.set_message`)."""

from __future__ import annotations

import array
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from rosidl_parser.definition import AbstractNestedType, NamespacedType

from .convert import get_message_slot_types
from .import_message import import_message_from_namespaced_type

StampSetter = Callable[[Any], None]


def set_message_fields(
    msg: Any, values: dict[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[StampSetter]:
    """Set the fields of a message, and of the messages in it, from a dictionary.

    Args:
        msg: the message to change.
        values: field names and values, as YAML gives them.
        expand_header_auto: whether a `std_msgs/msg/Header` field may be given as `auto`.
        expand_time_now: whether a `builtin_interfaces/msg/Time` field may be given as `now`.

    Returns:
        A setter for each field given as `auto` or `now`; call it with a Time message before publishing.

    Raises:
        AttributeError: the message has no field of a given name.
        TypeError: a field that is a message is given something other than a dictionary.
        ValueError: a value cannot be converted to its field's type.
        AssertionError: a value is out of its field's range or length (raised by the message's own setter).
    """
    stamps: list[StampSetter] = []
    _fill(msg, values, expand_header_auto, expand_time_now, stamps)
    return stamps


def _fill(msg: Any, values: Any, header_auto: bool, time_now: bool, stamps: list[StampSetter]) -> None:
    if not isinstance(values, dict):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    slots = get_message_slot_types(msg)
    for name, value in values.items():
        field = getattr(msg, name)
        slot = slots.get(name)
        if slot is None:
            raise AttributeError(f"'{type(msg).__name__}' object has no field '{name}'")
        if header_auto and value == "auto" and _is_message_type(slot, "std_msgs", "Header"):
            stamps.append(partial(setattr, field, "stamp"))
        elif time_now and value == "now" and _is_message_type(slot, "builtin_interfaces", "Time"):
            stamps.append(partial(setattr, msg, name))
        elif isinstance(slot, NamespacedType):
            _fill(field, value, header_auto, time_now, stamps)
        elif isinstance(slot, AbstractNestedType) and isinstance(slot.value_type, NamespacedType):
            element = import_message_from_namespaced_type(slot.value_type)
            messages = [element() for _ in value]
            for message, item in zip(messages, value, strict=True):
                _fill(message, item, header_auto, time_now, stamps)
            setattr(msg, name, messages)
        else:
            setattr(msg, name, _convert(field, value))


def _convert(field: Any, value: Any) -> Any:
    """Convert a value to the type of a field's current value."""
    if isinstance(field, array.array):
        return array.array(field.typecode, value)
    if isinstance(field, np.ndarray):
        return np.array(value, dtype=field.dtype)
    if isinstance(field, bytes) and isinstance(value, int):
        return bytes([value])
    return value if type(value) is type(field) else type(field)(value)


def _is_message_type(slot: Any, package: str, name: str) -> bool:
    return isinstance(slot, NamespacedType) and slot.namespaced_name() == (package, "msg", name)
