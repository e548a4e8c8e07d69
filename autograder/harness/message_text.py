"""Formats a ROS message as one short line."""

from __future__ import annotations

from itertools import islice
from typing import Any

from rcl_interfaces.msg import ParameterValue
from rclpy.parameter import parameter_value_to_python
from unique_identifier_msgs.msg import UUID

from autograder.harness.parameter_values import KNOWN_TYPES

MAX_ITEMS = 6  # of a list; the others are only counted
MAX_CHARACTERS = 200  # of a string; the others are left out


def format_message(message: Any) -> str:
    """Return a message's fields as a text of limited length, without UUIDs, empty strings and empty lists."""
    fields = {name: getattr(message, name) for name in type(message).get_fields_and_field_types()}
    texts = {name: _value(value) for name, value in fields.items() if not isinstance(value, UUID)}
    return ", ".join(f"{name}: {text}" for name, text in texts.items() if text not in ("''", "[]", "{}"))


def _value(value: Any) -> str:
    if isinstance(value, ParameterValue):
        if value.type not in KNOWN_TYPES:  # a node may answer anything
            return f"of the unknown type {value.type}"
        value = parameter_value_to_python(value)
    if hasattr(value, "get_fields_and_field_types"):
        return f"{{{format_message(value)}}}"
    if isinstance(value, str | bytes):
        return repr(value[:MAX_CHARACTERS]) + "…" * (len(value) > MAX_CHARACTERS)
    if isinstance(value, float):
        return f"{value:.6g}"
    if hasattr(value, "__len__"):
        suffix = f", … {len(value)} in all" if len(value) > MAX_ITEMS else ""
        return f"[{', '.join(map(_value, islice(value, MAX_ITEMS)))}{suffix}]"
    return str(value)
