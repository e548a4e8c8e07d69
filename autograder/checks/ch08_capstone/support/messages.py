"""The two messages of the contract, and how the student's definitions differ from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from autograder.checking import Workspace, expect, load_interfaces, nearest
from autograder.checking.probes import files, interfaces
from autograder.checks.ch08_capstone.support.contract import INTERFACES, LEVELS
from autograder.checks.ch08_capstone.support.sources import source_of


@dataclass(frozen=True)
class ExpectedMessage:
    """The fields that a message must have, with rosidl's names of their types, and its constants."""

    name: str
    fields: Mapping[str, str]
    constants: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class MessageTypes:
    """The student's two messages, as classes of plain values."""

    clearance: type
    health: type


HEADER = {"header": "std_msgs/Header"}
CLEARANCE = ExpectedMessage(
    "Clearance", {**HEADER, "valid": "boolean", "front": "float", "left": "float", "right": "float"}
)
HEALTH = ExpectedMessage(
    "Health",
    {**HEADER, "level": "uint8", "silent": "sequence<string>"},
    {name: value for value, name in enumerate(LEVELS)},
)
_ACCEPTED_TYPES = {"float": ("float", "double"), "uint8": ("uint8", "int8", "uint16", "int16", "uint32", "int32")}
# The types in a .msg file, by rosidl's names for them.
_MSG_TYPES = {"boolean": "bool", "float": "float32", "double": "float64", "sequence<string>": "string[]"}


def load_messages(workspace: Workspace) -> Any:
    """Return the student's messages, read from their definitions. Raises the errors of `load_interfaces`."""
    return load_interfaces(workspace, INTERFACES)


def message_types(package: Any) -> MessageTypes:
    """Return the two messages of a package. Other checks test whether they are exactly as the contract requires.

    Raises:
        CheckFailed: a message is missing, or lacks a field that the grader needs to communicate with the nodes.
    """
    for expected in (CLEARANCE, HEALTH):
        message = getattr(package.msg, expected.name, None)
        fields = message.get_fields_and_field_types() if message is not None else {}
        missing_fields = [
            name for name, kind in expected.fields.items() if fields.get(name) not in _ACCEPTED_TYPES.get(kind, (kind,))
        ]
        expect(
            not missing_fields,
            f"{expected.name}.msg does not define {', '.join(missing_fields)} as in step 3, "
            "so no other node can use this message.",
        )
    return MessageTypes(package.msg.Clearance, package.msg.Health)


def differences(workspace: Workspace, expected: ExpectedMessage) -> list[str]:
    """Describe how the student's definition of a message differs from the contract, and name near misses.

    Raises the errors of `load_interfaces`.
    """
    package = load_messages(workspace)
    message = getattr(package.msg, expected.name, None)
    if message is None:
        available = sorted(name for name in vars(package.msg) if name[:1].isupper())
        return [f"There is no msg/{expected.name}.msg. Existing messages: {', '.join(available) or 'none'}."]
    fields = message.get_fields_and_field_types()
    errors = [_field_error(expected.name, name, kind, fields) for name, kind in expected.fields.items()]
    extra_fields = [
        name for name in fields if name not in expected.fields and not _is_near_miss(name, expected, fields)
    ]
    errors += [f"{expected.name} has a field {name} that is not in the contract." for name in extra_fields]
    errors = [error for error in errors if error]
    if not errors and list(fields) != list(expected.fields):
        errors = [
            f"The fields of {expected.name} are in the order {', '.join(fields)}, "
            f"instead of {', '.join(expected.fields)}."
        ]
    return errors + _differences_in_text(workspace, expected)


def _differences_in_text(workspace: Workspace, expected: ExpectedMessage) -> list[str]:
    """Describe wrong constants and default values. The loaded classes contain neither."""
    path = f"msg/{expected.name}.msg"
    data = files.read_limited(source_of(workspace, INTERFACES) / path, interfaces.MAX_BYTES, path)
    try:
        (definition,) = interfaces.parse(INTERFACES, path, data.decode(errors="replace")).parts
    except interfaces.Unreadable as error:
        return [str(error)]
    constants = {constant.name: (constant.type, constant.value) for constant in definition.constants}
    return [
        f"{expected.name} has no constant uint8 {name}={value}."
        for name, value in expected.constants.items()
        if constants.get(name) != ("uint8", value)
    ] + [
        f"{expected.name}.{field.name} has the default {field.default!r}, but no field may have a default."
        for field in definition.fields
        if field.default is not None
    ]


def _field_error(message: str, name: str, kind: str, fields: Mapping[str, str]) -> str:
    if name not in fields:
        similar = nearest(name, fields)
        return f"{message} has no field {name}{f'; it has {similar}' if similar else ''}."
    if fields[name] != kind:
        return f"{message}.{name} has the type {_msg_type(fields[name])}, instead of {_msg_type(kind)}."
    return ""


def _is_near_miss(name: str, expected: ExpectedMessage, fields: Mapping[str, str]) -> bool:
    """Return whether an extra field was named as the near miss of a missing one."""
    return any(nearest(missing, fields) == name for missing in expected.fields if missing not in fields)


def _msg_type(kind: str) -> str:
    return _MSG_TYPES.get(kind, kind)
