"""Interface definitions against a contract: texts of .msg, .srv and .action files, compared with near misses named.

Pure: texts go in, sentences come out. `rosidl_adapter`, the parser of the build itself, interprets the texts.
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
READ_AS = {"msg": "message", "srv": "service", "action": "action"}  # in the names of the parser's functions
_NEAR = 0.7  # of difflib's ratio: how alike two names must be to be one name, misspelt


class Unreadable(Exception):
    """A definition that the build would refuse; the message says why."""


class Aspect(str, Enum):
    """The aspects in which two definitions can differ."""

    FIELDS = "fields"  # a field's name, place or order
    TYPES = "types"
    BOUNDS = "bounds"  # how many elements or characters there may be
    DEFAULTS = "defaults"
    CONSTANTS = "constants"


@dataclass(frozen=True)
class Field:
    """A field: `type` as one writes it (`float64[<=8]`, `std_msgs/Header`), `default` None when it has none."""

    type: str
    name: str
    default: Any = None

    @property
    def element(self) -> str:
        """The type without bounds: `float64[<=8]` is a `float64[]`; `float64[8]`, of one size, is itself."""
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
        package: the name of the package that it belongs to.
        path: `msg/Name.msg`, `srv/Name.srv` or `action/Name.action`.
        text: the file's.

    Raises:
        Unreadable: the build would refuse it.
    """
    kind, _, file = path.partition("/")
    name = file.removesuffix(f".{kind}")
    if len(text) > MAX_BYTES:
        raise Unreadable(f"{path} is far larger than a definition.")
    try:
        with contextlib.redirect_stderr(io.StringIO()):
            whole = getattr(rosidl.parser(), f"parse_{READ_AS[kind]}_string")(
                package, name, rosidl.without_comments(text)
            )
    except Exception as error:  # the parser raises NameError, TypeError, ValueError and its own
        raise Unreadable(f"{path} cannot be read: {_reason(error)}.") from None
    return Interface(path, tuple(_part(package, getattr(whole, part) if part else whole) for part in PARTS[kind]))


def compare(expected: Interface, actual: Interface) -> tuple[Difference, ...]:
    """Return how a definition differs from its contract; the empty tuple if it does not.

    Additional constants, and a default that equals the value without one, are not differences.
    """
    parts = range(len(expected.parts))
    return tuple(difference for index in parts for difference in _Comparison(expected, actual, index).differences())


def elements(expected: Interface, aspect: Aspect) -> Iterator[Field | Constant]:
    """Yield the constants or fields to which an aspect of a contract applies. Unbounded arrays have bounds, too."""
    for part in expected.parts:
        if aspect is Aspect.CONSTANTS:
            yield from part.constants
        elif aspect is Aspect.DEFAULTS:
            yield from (field for field in part.fields if field.default is not None)
        elif aspect is Aspect.BOUNDS:
            yield from (field for field in part.fields if {"<", "["} & set(field.type))


def share(expected: Interface, differences: Sequence[Difference]) -> float:
    """Return which share of a contract's elements is right, in [0, 1]."""
    elements = sum(len(part.fields) + len(part.constants) for part in expected.parts)
    return max(0.0, 1.0 - len(differences) / elements) if elements else float(not differences)


def closest(path: str, present: Sequence[str]) -> str:
    """Return the definition in `present` that is most likely meant by `path`, the empty string if none is."""
    by_case = {other.casefold(): other for other in present}
    return by_case.get(nearest(path.casefold(), by_case, 0.8), "")


class _Comparison:
    """One part of a definition against the same part of its contract."""

    def __init__(self, expected: Interface, actual: Interface, index: int) -> None:
        self._part = expected.parts[index]
        self._actual = actual.parts[index]
        others = [other for other in range(len(expected.parts)) if other != index]
        names = PARTS[expected.path.partition("/")[0]]
        self._elsewhere = {
            name: names[other]
            for other in others
            for name in _names(actual.parts[other]) - _names(expected.parts[other])
        }
        self._strayed = {
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
        constants = {constant.name.lower() for constant in self._part.constants}  # `_constants` speaks of those
        extra = [name for name in actual if name not in expected and name not in constants]
        for name in (name for name in expected if name not in actual):
            if name in self._elsewhere:
                yield self._difference(Aspect.FIELDS, f"{name} is in the {self._elsewhere[name]}, it belongs here")
            elif near := nearest(name, (other for other in extra if other not in self._strayed), _NEAR):
                extra.remove(near)
                yield self._difference(Aspect.FIELDS, f"a field is called {near}, it should be {name}")
            else:
                yield self._difference(Aspect.FIELDS, f"the field {name} is missing")
        for name in extra:
            if name not in self._strayed:
                yield self._difference(Aspect.FIELDS, f"the contract has no field {name}")
        if expected.keys() == actual.keys() and list(expected) != list(actual):
            order, other = ", ".join(expected), ", ".join(actual)
            yield self._difference(Aspect.FIELDS, f"the order of the fields is {other}, it should be {order}")

    def _field(self, expected: Field, actual: Field) -> Iterator[Difference]:
        if expected.element != actual.element:
            yield self._difference(Aspect.TYPES, f"{actual.name} is {actual.type}, it should be {expected.type}")
        elif expected.type != actual.type:
            yield self._difference(Aspect.BOUNDS, f"{actual.name} is {actual.type}, it should be {expected.type}")
        if expected.default != actual.default and not (expected.default is None and not actual.default):
            says = "no default" if actual.default is None else f"the default {actual.default!r}"
            should = "none" if expected.default is None else repr(expected.default)
            yield self._difference(Aspect.DEFAULTS, f"{actual.name} has {says}, it should be {should}")

    def _constants(self) -> Iterator[Difference]:
        constants = {constant.name: constant for constant in self._actual.constants}
        fields = [field.name for field in self._actual.fields]
        extra = [name for name in constants if name not in _names(self._part)]
        for constant in self._part.constants:
            name, there = constant.name, constants.get(constant.name)
            if there is not None:
                if (there.type, there.value) != (constant.type, constant.value):
                    says, should = f"{there.type} {there.value!r}", f"{constant.type} {constant.value!r}"
                    yield self._difference(Aspect.CONSTANTS, f"the constant {name} is {says}, it should be {should}")
            elif name in self._elsewhere:
                where = self._elsewhere[name]
                yield self._difference(Aspect.CONSTANTS, f"the constant {name} is in the {where}, it belongs here")
            elif name.lower() in fields:
                sentence = f"{name.lower()} is a field; a constant is written {constant.type} {name} = VALUE"
                yield self._difference(Aspect.CONSTANTS, sentence)
            elif near := nearest(name, extra, _NEAR):
                yield self._difference(Aspect.CONSTANTS, f"a constant is called {near}, it should be {name}")
            else:
                yield self._difference(Aspect.CONSTANTS, f"the constant {name} is missing")

    def _difference(self, aspect: Aspect, sentence: str) -> Difference:
        return Difference(aspect, f"{self._where}: {sentence}.")


def _names(part: Part) -> set[str]:
    return {field.name for field in part.fields} | {constant.name for constant in part.constants}


def _part(package: str, spec: Any) -> Part:
    own = f"{package}/"
    return Part(
        tuple(
            Field(str(field.type).removeprefix(own), field.name, _plain(field.default_value)) for field in spec.fields
        ),
        tuple(Constant(str(each.type), each.name, _plain(each.value)) for each in spec.constants),
    )


def _plain(value: Any) -> Any:
    """Return a default or a constant's value as Python has it; the parser keeps the quotes of some strings."""
    return value.strip("\"'") if isinstance(value, str) else value


def _reason(error: Exception) -> str:
    """Put the parser's exception into words; some hold only the line, or nothing."""
    about = {
        "InvalidServiceSpecification": "one line --- parts the request from the response",
        "InvalidActionSpecification": "two lines --- part goal, result and feedback",
    }.get(type(error).__name__, "a field is written `type name`, a constant `type NAME = value`")
    text = str(error).strip()
    return f"{text} ({about})" if text else about
