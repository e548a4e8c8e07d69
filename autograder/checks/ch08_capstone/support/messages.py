"""The student's two messages: what they must hold, and what they hold instead."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from autograder.checking import Workspace, expect, load_interfaces, nearest
from autograder.checking.probes import files, interfaces
from autograder.checks.ch08_capstone.support.contract import INTERFACES, LEVELS
from autograder.checks.ch08_capstone.support.sources import source_of


@dataclass(frozen=True)
class Message:
    """What a message must hold: fields by name with their types, as rosidl calls them, and constants."""

    name: str
    fields: Mapping[str, str]
    constants: Mapping[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Types:
    """The student's two messages, as classes of plain values."""

    clearance: type
    health: type


HEADER = {"header": "std_msgs/Header"}
CLEARANCE = Message("Clearance", {**HEADER, "valid": "boolean", "front": "float", "left": "float", "right": "float"})
HEALTH = Message(
    "Health",
    {**HEADER, "level": "uint8", "silent": "sequence<string>"},
    {name: value for value, name in enumerate(LEVELS)},
)
_LIKE = {"float": ("float", "double"), "uint8": ("uint8", "int8", "uint16", "int16", "uint32", "int32")}
# rosidl's names of types, in the words of a .msg file.
_WORDS = {"boolean": "bool", "float": "float32", "double": "float64", "sequence<string>": "string[]"}


def load_messages(workspace: Workspace) -> Any:
    """Return the student's messages, read from their text. Raises as `load_interfaces` does."""
    return load_interfaces(workspace, INTERFACES)


def types(package: Any) -> Types:
    """Return the two messages of a package; whether they are exactly as they must be is for other checks to say.

    Raises:
        CheckFailed: one is missing, or lacks a field of a kind with which the nodes could be understood.
    """
    for wanted in (CLEARANCE, HEALTH):
        message = getattr(package.msg, wanted.name, None)
        fields = message.get_fields_and_field_types() if message is not None else {}
        absent = [name for name, kind in wanted.fields.items() if fields.get(name) not in _LIKE.get(kind, (kind,))]
        expect(
            not absent, f"{wanted.name}.msg has no {', '.join(absent)} as step 3 says: nobody understands the nodes."
        )
    return Types(package.msg.Clearance, package.msg.Health)


def differences(workspace: Workspace, wanted: Message) -> list[str]:
    """Say where a message of the student's differs from what it must hold, near misses named.

    Raises as `load_interfaces` does.
    """
    package = load_messages(workspace)
    found = getattr(package.msg, wanted.name, None)
    if found is None:
        there = sorted(name for name in vars(package.msg) if name[:1].isupper())
        return [f"There is no msg/{wanted.name}.msg; there is {', '.join(there) or 'no message'}."]
    fields = found.get_fields_and_field_types()
    said = [_field(wanted.name, name, kind, fields) for name, kind in wanted.fields.items()]
    extra = [name for name in fields if name not in wanted.fields and not _stands_for(name, wanted, fields)]
    said += [f"{wanted.name} has a field {name} that is not asked for." for name in extra]
    said = [sentence for sentence in said if sentence]
    if not said and list(fields) != list(wanted.fields):
        said = [
            f"The fields of {wanted.name} are in the order {', '.join(fields)}: {', '.join(wanted.fields)} is asked."
        ]
    return said + _differences_of_text(workspace, wanted)


def _differences_of_text(workspace: Workspace, wanted: Message) -> list[str]:
    """Say which constants are missing, or are others, and which fields have a default: no class knows that."""
    path = f"msg/{wanted.name}.msg"
    data = files.read_plain(source_of(workspace, INTERFACES) / path, interfaces.MAX_BYTES + 1) or b""
    try:
        (part,) = interfaces.parse(INTERFACES, path, data.decode(errors="replace")).parts
    except interfaces.Unreadable as error:
        return [str(error)]
    constants = {constant.name: (constant.type, constant.value) for constant in part.constants}
    return [
        f"{wanted.name} has no constant uint8 {name}={value}."
        for name, value in wanted.constants.items()
        if constants.get(name) != ("uint8", value)
    ] + [
        f"{wanted.name}.{field.name} has a default, {field.default!r}: no field has one."
        for field in part.fields
        if field.default is not None
    ]


def _field(message: str, name: str, kind: str, fields: Mapping[str, str]) -> str:
    if name not in fields:
        near = nearest(name, fields)
        return f"{message} has no field {name}{f'; it has {near}' if near else ''}."
    if fields[name] != kind:
        return f"{message}.{name} is {_word(fields[name])}, the contract asks {_word(kind)}."
    return ""


def _stands_for(name: str, wanted: Message, fields: Mapping[str, str]) -> bool:
    """Say whether a field that is not asked for was named as the near miss of one that is missing."""
    return any(nearest(missing, fields) == name for missing in wanted.fields if missing not in fields)


def _word(kind: str) -> str:
    return _WORDS.get(kind, kind)
