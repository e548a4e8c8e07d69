"""Compares interface definitions, the texts of .msg, .srv and .action files, with a contract, and names near misses.

The module reads no files and returns sentences. `rosidl_adapter`, which the build uses, parses the texts.
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from autograder.building.interfaces import rosidl
from autograder.plain_text import nearest

MAX_BYTES = 64 * 1024
PARTS = {"msg": ("",), "srv": ("request", "response"), "action": ("goal", "result", "feedback")}
PARSER_KINDS = {"msg": "message", "srv": "service", "action": "action"}  # as in the names of the parser's functions
_NEAR = 0.7  # names with at least this difflib ratio count as misspellings of each other


class Unreadable(Exception):
    """A definition that the build would reject; the message says why."""


class Aspect(str, Enum):
    """The aspects in which two definitions can differ."""

    FIELDS = "fields"  # a field's name, position or order
    TYPES = "types"
    BOUNDS = "bounds"  # the maximum number of elements or characters
    DEFAULTS = "defaults"
    CONSTANTS = "constants"


@dataclass(frozen=True)
class Field:
    """A field: its `type` as a definition writes it (`float64[<=8]`, `std_msgs/Header`), its name and its default."""

    type: str
    name: str
    default: Any = None

    @property
    def element(self) -> str:
        """The type without bounds: `float64[]` for `float64[<=8]`. An array of fixed size has no bounds."""
        element, _, array = self.type.partition("[")
        plain = element.partition("<")[0]
        return plain if not array else f"{plain}[]" if array.startswith(("<", "]")) else f"{plain}[{array}"


@dataclass(frozen=True)
class Constant:
    """A constant."""

    type: str
    name: str
    value: Any


@dataclass(frozen=True)
class Part:
    """A message, or one part of a service or an action."""

    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()


@dataclass(frozen=True)
class Interface:
    """A definition: its path in the package, such as `srv/CheckTrip.srv`, and its parts as in `PARTS`."""

    path: str
    parts: tuple[Part, ...]


@dataclass(frozen=True)
class Difference:
    """One difference from the contract: its aspect, and a sentence for the author of the definition."""

    aspect: Aspect
    sentence: str


def parse(package: str, path: str, text: str) -> Interface:
    """Read a definition.

    Args:
        package: the name of the package that contains it.
        path: `msg/Name.msg`, `srv/Name.srv` or `action/Name.action`.
        text: the text of the file.

    Raises:
        Unreadable: the build would reject it.
    """
    kind, _, file = path.partition("/")
    name = file.removesuffix(f".{kind}")
    if len(text) > MAX_BYTES:
        raise Unreadable(f"{path} is far larger than a definition.")
    try:
        with contextlib.redirect_stderr(io.StringIO()):
            spec = getattr(rosidl.parser(), f"parse_{PARSER_KINDS[kind]}_string")(
                package, name, rosidl.without_comments(text)
            )
    except Exception as error:  # the parser raises NameError, TypeError, ValueError and its own
        raise Unreadable(f"{path} cannot be read: {_reason(error)}.") from None
    return Interface(path, tuple(_part(package, getattr(spec, part) if part else spec) for part in PARTS[kind]))


def compare(expected: Interface, actual: Interface) -> tuple[Difference, ...]:
    """Return the differences of a definition from its contract.

    Additional constants are not differences, nor is a default that equals the value of a field without a default.
    """
    parts = range(len(expected.parts))
    return tuple(difference for index in parts for difference in _Comparison(expected, actual, index).differences())


def elements(expected: Interface, aspect: Aspect) -> Iterator[Field | Constant]:
    """Yield the fields or constants to which an aspect of a contract applies. Bounds also apply to unbounded arrays."""
    for part in expected.parts:
        if aspect is Aspect.CONSTANTS:
            yield from part.constants
        elif aspect is Aspect.DEFAULTS:
            yield from (field for field in part.fields if field.default is not None)
        elif aspect is Aspect.BOUNDS:
            yield from (field for field in part.fields if {"<", "["} & set(field.type))


def share(expected: Interface, differences: Sequence[Difference]) -> float:
    """Return the share of a contract's elements that are correct, from 0 to 1."""
    elements = sum(len(part.fields) + len(part.constants) for part in expected.parts)
    return max(0.0, 1.0 - len(differences) / elements) if elements else float(not differences)


def closest(path: str, present: Sequence[str]) -> str:
    """Return the path in `present` that was probably meant to be `path`, or an empty string."""
    by_case = {other.casefold(): other for other in present}
    return by_case.get(nearest(path.casefold(), by_case, 0.8), "")


class _Comparison:
    """Compares one part of a definition with the same part of its contract."""

    def __init__(self, expected: Interface, actual: Interface, index: int) -> None:
        self._part = expected.parts[index]
        self._actual = actual.parts[index]
        others = [other for other in range(len(expected.parts)) if other != index]
        names = PARTS[expected.path.partition("/")[0]]
        # For each name that another part contains against its contract, the name of that part.
        self._actual_part = {
            name: names[other]
            for other in others
            for name in _names(actual.parts[other]) - _names(expected.parts[other])
        }
        # The names that other parts should contain, but do not.
        self._missing_elsewhere = {
            name for other in others for name in _names(expected.parts[other]) - _names(actual.parts[other])
        }
        self._name = names[index]
        self._where = f"{expected.path}, {names[index]}" if names[index] else expected.path

    def differences(self) -> Iterator[Difference]:
        expected = {field.name: field for field in self._part.fields}
        actual = {field.name: field for field in self._actual.fields}
        yield from self._names(expected, actual)
        for name in expected.keys() & actual.keys():
            yield from self._field(expected[name], actual[name])
        yield from self._constants()

    def _names(self, expected: Mapping[str, Field], actual: Mapping[str, Field]) -> Iterator[Difference]:
        constants = {constant.name.lower() for constant in self._part.constants}  # `_constants` reports those
        extra = [name for name in actual if name not in expected and name not in constants]
        for name in (name for name in expected if name not in actual):
            if name in self._actual_part:
                yield self._difference(
                    Aspect.FIELDS, f"{name} is in the {self._actual_part[name]}, but it belongs here"
                )
            elif near := nearest(name, (other for other in extra if other not in self._missing_elsewhere), _NEAR):
                extra.remove(near)
                yield self._difference(Aspect.FIELDS, f"a field is called {near}, but it should be {name}")
            else:
                yield self._difference(Aspect.FIELDS, f"the field {name} is missing")
        for name in extra:
            if name not in self._missing_elsewhere:
                yield self._difference(Aspect.FIELDS, f"the contract has no field {name}")
        if expected.keys() == actual.keys() and list(expected) != list(actual):
            order, other = ", ".join(expected), ", ".join(actual)
            yield self._difference(Aspect.FIELDS, f"the order of the fields is {other}, but it should be {order}")

    def _field(self, expected: Field, actual: Field) -> Iterator[Difference]:
        if expected.element != actual.element:
            yield self._difference(Aspect.TYPES, f"{actual.name} is {actual.type}, but it should be {expected.type}")
        elif expected.type != actual.type:
            yield self._difference(Aspect.BOUNDS, f"{actual.name} is {actual.type}, but it should be {expected.type}")
        if expected.default != actual.default and not (expected.default is None and not actual.default):
            actual_text = "no default" if actual.default is None else f"the default {actual.default!r}"
            expected_text = "none" if expected.default is None else repr(expected.default)
            yield self._difference(
                Aspect.DEFAULTS, f"{actual.name} has {actual_text}, but it should be {expected_text}"
            )

    def _constants(self) -> Iterator[Difference]:
        constants = {constant.name: constant for constant in self._actual.constants}
        fields = [field.name for field in self._actual.fields]
        extra = [name for name in constants if name not in _names(self._part)]
        for expected in self._part.constants:
            name, actual = expected.name, constants.get(expected.name)
            if actual is not None:
                if (actual.type, actual.value) != (expected.type, expected.value):
                    texts = [f"{constant.type} {constant.value!r}" for constant in (actual, expected)]
                    sentence = f"the constant {name} is {texts[0]}, but it should be {texts[1]}"
                    yield self._difference(Aspect.CONSTANTS, sentence)
            elif name in self._actual_part:
                part = self._actual_part[name]
                yield self._difference(Aspect.CONSTANTS, f"the constant {name} is in the {part}, but it belongs here")
            elif name.lower() in fields:
                sentence = f"{name.lower()} is a field; a constant is written {expected.type} {name} = VALUE"
                yield self._difference(Aspect.CONSTANTS, sentence)
            elif near := nearest(name, extra, _NEAR):
                yield self._difference(Aspect.CONSTANTS, f"a constant is called {near}, but it should be {name}")
            else:
                yield self._difference(Aspect.CONSTANTS, f"the constant {name} is missing")

    def _difference(self, aspect: Aspect, sentence: str) -> Difference:
        return Difference(aspect, f"{self._where}: {sentence}.")


def _names(part: Part) -> set[str]:
    return {field.name for field in part.fields} | {constant.name for constant in part.constants}


def _part(package: str, spec: Any) -> Part:
    prefix = f"{package}/"
    return Part(
        tuple(
            Field(str(field.type).removeprefix(prefix), field.name, _plain(field.default_value))
            for field in spec.fields
        ),
        tuple(Constant(str(constant.type), constant.name, _plain(constant.value)) for constant in spec.constants),
    )


def _plain(value: Any) -> Any:
    """Return the value of a default or a constant. The parser leaves some strings in quotes."""
    return value.strip("\"'") if isinstance(value, str) else value


def _reason(error: Exception) -> str:
    """Describe an exception of the parser. Some have no text, or only the line of the definition."""
    advice = {
        "InvalidServiceSpecification": "one line --- separates the request from the response",
        "InvalidActionSpecification": "two lines --- separate goal, result and feedback",
    }.get(type(error).__name__, "a field is written `type name`, a constant `type NAME = value`")
    text = str(error).strip()
    return f"{text} ({advice})" if text else advice
