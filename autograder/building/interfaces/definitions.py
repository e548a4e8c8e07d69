"""Interface definitions as plain values, from which a text without the author's formatting can be generated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

KINDS = ("msg", "srv", "action")


class InterfaceError(Exception):
    """Base class of all errors about an interface package."""


class DefinitionError(InterfaceError):
    """A definition is wrong, and its author can correct it. The message names the file and, if known, the line."""

    def __init__(self, file: str, problem: str, line: str = "") -> None:
        location = f"{file}, line “{line[:120]}”" if line else file
        super().__init__(f"{location}: {problem}")
        self.file, self.line = file, line


Value = bool | int | float | str
"""The value of a constant. The default of a field may also be a list of such values."""


@dataclass(frozen=True)
class Field:
    """A field of a message."""

    name: str
    base: str  # a basic type, such as `float64`, or the name of a message, such as `Header`
    package: str | None = None  # the package of a message
    max_length: int | None = None  # the maximum length of a string
    is_array: bool = False
    size: int | None = None  # the number of elements of an array
    is_upper_bound: bool = False  # whether `size` is only the maximum
    default: Value | list[Value] | None = None

    def __str__(self) -> str:
        """Return the line that defines the field."""
        base = f"{self.package}/{self.base}" if self.package else self.base
        length = "" if self.max_length is None else f"<={self.max_length}"
        array = f"[{'<=' * self.is_upper_bound}{'' if self.size is None else self.size}]" if self.is_array else ""
        return f"{base}{length}{array} {self.name}{'' if self.default is None else f' {_literal(self.default)}'}"


@dataclass(frozen=True)
class Constant:
    """A constant of a message."""

    name: str
    base: str
    value: Value

    def __str__(self) -> str:
        """Return the line that defines the constant."""
        return f"{self.base} {self.name}={_literal(self.value)}"


@dataclass(frozen=True)
class Section:
    """A message, or one section of a service or an action."""

    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()

    def __str__(self) -> str:
        """Return the lines that define the section."""
        return "".join(f"{element}\n" for element in (*self.constants, *self.fields))


@dataclass(frozen=True)
class Definition:
    """The definition of a message, service or action."""

    path: str  # such as `msg/RobotStatus.msg`
    sections: tuple[Section, ...]
    uses: tuple[tuple[str, str, str], ...]  # messages of other packages that it contains: (package, type, line's text)
    elements: int = 1  # the number of elements for which a new message allocates memory

    @property
    def text(self) -> str:
        """The generated text of the definition."""
        return "---\n".join(map(str, self.sections))


def _literal(value: Value | list[Value]) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_literal, value))}]"
    if isinstance(value, str):
        return next((f"{quote}{value}{quote}" for quote in "\"'" if quote not in value), value)
    return repr(value).lower()


def require_uses(definitions: tuple[Definition, ...], exists: Callable[[str, str | None], bool]) -> None:
    """Raise a DefinitionError unless all messages of other packages that the definitions contain exist.

    `exists` returns whether a package has the given message, or whether the package exists if the message is None.
    """
    for definition in definitions:
        for package, name, line in definition.uses:
            if not exists(package, None):
                raise DefinitionError(definition.path, f"there is no package {package} with messages here", line)
            if not exists(package, name):
                raise DefinitionError(definition.path, f"{package} has no message {name}: correct the name", line)


def packages_used(definitions: tuple[Definition, ...]) -> Iterator[str]:
    """Yield the other packages that these definitions need, including those that every service or action needs."""
    yield from (package for definition in definitions for package, _, _ in definition.uses)
    kinds = {definition.path.split("/")[0] for definition in definitions}
    if kinds & {"srv", "action"}:
        yield from ("service_msgs", "builtin_interfaces")
    if "action" in kinds:
        yield from ("action_msgs", "unique_identifier_msgs")
