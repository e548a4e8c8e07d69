"""Messages of plain values have the same bytes on the wire as rosidl's generated messages."""

from __future__ import annotations

import json
import random
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from autograder.building.interfaces import Cache
from autograder.building.interfaces.prefix import build
from autograder.ros.environment import site_packages
from tests.e2e.sandbox_support import in_worker_sandbox

PACKAGE = "wire_msgs"
KINDS = (
    *("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64"),
    *("uint64", "string", "wstring", "string<=9", "std_msgs/Header", "Inner", "Nothing"),
)
ARRAYS = ("", "[2]", "[]", "[<=3]")
PAIRS = [(i, j) for i in range(len(KINDS)) for j in range(len(ARRAYS)) if j in (0, 1 + i % 3)]
LINES = [f"{KINDS[i]}{ARRAYS[j]} f{i}x{j}" for i, j in PAIRS]
DEFAULTS = ("float32[3] a [1, 2.5, -3]", "int64[<=4] b [7]", "string[] c ['x', 'y']", "byte d 9", "bool[2] e [1, 0]")
TEXTS = {
    "msg/Nothing.msg": "int8 ONE=1\n",
    "msg/Inner.msg": "bool b true\nfloat64 d\nint16[] s [1, -2]\nstring text 'a b'\n",
    # In an order that mixes alignments.
    "msg/All.msg": "\n".join(LINES[::3] + LINES[1::3] + LINES[2::3]) + "\n",
    "msg/Defaults.msg": "\n".join(DEFAULTS),
    "srv/Ask.srv": "Inner[] question\n---\nfloat32 answer\n",
    "action/Go.action": "Inner goal\n---\n---\nint8 seen\n",
}
MESSAGES = 10
HEADER = bytes([0, 1, 0, 0])  # of little-endian CDR


def _value(kind: Any, draw: random.Random, new: Callable[[Any], Any]) -> Any:
    """Draw a value for a field: a list for an array or a sequence."""
    from rosidl_parser import definition as rosidl

    if isinstance(kind, rosidl.AbstractNestedType):
        max_length = kind.size if isinstance(kind, rosidl.Array) else 3
        count = max_length if isinstance(kind, rosidl.Array) else draw.randint(0, max_length)
        return [_value(kind.value_type, draw, new) for _ in range(count)]
    if isinstance(kind, rosidl.NamespacedType):
        return new(kind)
    if isinstance(kind, rosidl.AbstractGenericString):
        return "".join(draw.choice("aé€ z") for _ in range(draw.randint(0, 3)))
    if kind.typename == "boolean":
        return draw.random() < 0.5
    if kind.typename == "octet":
        return bytes([draw.randrange(256)])
    if kind.typename in ("float", "double"):
        return draw.randint(-1000, 1000) / 8
    bits = int(kind.typename.lstrip("uint"))
    return draw.randrange(2**bits) - (0 if kind.typename[0] == "u" else 2 ** (bits - 1))


def _fill(plain: Any, draw: random.Random) -> Any:
    """Set each field of a new message."""

    def new(kind: Any) -> Any:
        message = plain._known.make(kind)
        return _fill(message, draw) if hasattr(message, "_known") else message

    for name in plain._defaults:
        setattr(plain, name, _value(plain._members[name], draw, new))
    return plain


def _real(plain: Any) -> Any:
    """Return a generated message with the values of a plain one."""
    if isinstance(plain, list):
        return [_real(item) for item in plain]
    if not hasattr(plain, "_known"):
        return plain
    package, family, _ = plain._type.namespaced_name()
    kind: Any = import_module(f"{package}.{family}")
    for part in plain._type.name.split("_"):
        kind = getattr(kind, part)
    return kind(**{name: _real(getattr(plain, name)) for name in plain._defaults})


def compare(scratch: Path) -> dict[str, Any]:
    """Read the bytes of plain messages as generated ones, and the reverse; return differences and the fields' types."""
    from rclpy.serialization import deserialize_message, serialize_message
    from rosidl_parser.definition import NamespacedType

    from autograder.building.interfaces import messages
    from autograder.building.interfaces.loading import classes

    prefix = build(PACKAGE, TEXTS, cache=Cache(scratch / "cache"))
    sys.path.insert(0, str(site_packages(prefix)))
    package = classes(((PACKAGE, tuple(TEXTS.items())),))
    draw, differences = random.Random(7), []
    kinds = [*vars(package.msg).values(), package.srv.Ask.Request, package.srv.Ask.Response]
    kinds += [package.action.Go.Goal, package.action.Go.Result, package.action.Go.Feedback]
    kinds = [kind for kind in kinds if isinstance(kind, type)]
    for kind in kinds:
        for message in (kind(), *(_fill(kind(), draw) for _ in range(MESSAGES))):
            data = messages.to_bytes(message)
            real = _real(messages.from_bytes(kind, data))
            if deserialize_message(HEADER + data, type(real)) != real:
                differences.append([repr(message), "is read differently by rosidl", data.hex()])
            if messages.to_bytes(messages.from_bytes(kind, serialize_message(real)[len(HEADER) :])) != data:
                differences.append(
                    [repr(message), "is read differently from rosidl's bytes", serialize_message(real).hex()]
                )
    generated = import_module(f"{PACKAGE}.msg")
    fields = [generated.All.get_fields_and_field_types(), package.msg.All.get_fields_and_field_types()]
    described = [json.loads(path.read_text()) for path in prefix.glob(f"share/{PACKAGE}/*/*.json")]
    hashes = {entry["type_name"]: entry["hash_string"] for file in described for entry in file["type_hashes"]}
    for name, expected in hashes.items():
        if name.startswith(PACKAGE):
            *namespaces, type_name = name.split("/")
            actual = package.msg.Inner._known.hash(NamespacedType(namespaces, type_name))
            differences += [] if actual == expected else [[name, actual, expected]]
    return {"hashes": len(hashes), "differences": differences[:3], "messages": len(kinds), "fields": fields}


def test_the_bytes_of_plain_messages_are_those_of_generated_ones() -> None:
    answer = in_worker_sandbox(compare)
    assert answer["differences"] == []
    assert answer["messages"] == 9
    assert answer["hashes"] > 20
    assert answer["fields"][0] == answer["fields"][1]
