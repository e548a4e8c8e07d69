"""Parses the texts of interface definitions. Their size is limited, and errors name the line.

The definitions are parsed by rosidl's parser. This module also rejects names and sizes that the parser accepts but that
generated code cannot handle, such as keywords of C and Python and huge arrays. The generators get new definitions,
written from the parsed values without comments. So they never read the author's text, and comments do not affect a
type's hash.
"""

from __future__ import annotations

import contextlib
import io
import keyword
import math
import re
from collections.abc import Mapping
from typing import Any

from autograder.building.interfaces import rosidl
from autograder.building.interfaces.definitions import Constant, Definition, DefinitionError, Field, Section

MAX_FILES = 64  # definitions in a package
MAX_BYTES = 64 * 1024  # of a definition
MAX_FIELDS = 512  # of a section of a definition
MAX_ELEMENTS = 100_000  # of all fixed arrays in a message, including those in nested messages
FOREIGN_ELEMENTS = 128  # how many elements a message of a ROS package is assumed to have
SECTIONS = {"msg": 1, "srv": 2, "action": 3}  # how many sections a definition of each kind has
SEPARATOR_ADVICE = {
    "msg": "a message has none",
    "srv": "request --- response",
    "action": "goal --- result --- feedback",
}

_PATH = re.compile(r"(msg|srv|action)/([A-Z][A-Za-z0-9]{0,79})\.(msg|srv|action)")
_PACKAGE = re.compile(r"(?!.*__)[a-z][a-z0-9_]{0,78}[a-z0-9]")
_PRINTABLE = re.compile(r"[ -~]*")
# Words that cannot be names of fields, because the generated structures are compiled both as C and as C++.
_C_WORDS = frozenset(
    re.findall(
        r"\w+",
        """
    alignas alignof and asm auto bitand bitor bool break case catch char class compl const constexpr continue
    decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto if
    inline int long mutable namespace new noexcept not nullptr operator or private protected public register
    reinterpret_cast restrict return short signed sizeof static static_assert static_cast struct switch template
    this thread_local throw true try typedef typeid typename typeof union unsigned using virtual void volatile
    wchar_t while xor linux unix errno
    """,
    )
)


def require_package_name(name: str) -> None:
    """Raise a DefinitionError unless ROS accepts the name for an interface package."""
    if not _PACKAGE.fullmatch(name) or keyword.iskeyword(name):
        raise DefinitionError(
            "package.xml", f"{name[:80]!r} is not a package name: start with a letter, use a-z, 0-9, single underscores"
        )


def read(
    package: str, files: Mapping[str, str], foreign: Mapping[tuple[str, str], int] | None = None
) -> tuple[Definition, ...]:
    """Read the definitions of a package.

    Args:
        package: the package's name.
        files: the texts of the definitions by their paths, such as `msg/RobotStatus.msg`.
        foreign: how many elements messages of other packages have, if known, by package and name.

    Raises:
        DefinitionError: a definition is wrong. The exception names the file and the line of the first error.
    """
    require_package_name(package)
    if not files:
        raise DefinitionError(package, "no .msg, .srv or .action file: put them into msg/, srv/ and action/")
    if len(files) > MAX_FILES:
        raise DefinitionError(package, f"{len(files)} definitions, but at most {MAX_FILES} are read")
    for path in files:
        match = _PATH.fullmatch(path)
        if not match or match[1] != match[3]:
            raise DefinitionError(
                path[:120], "definitions are called msg/Name.msg, srv/Name.srv or action/Name.action, Name in CamelCase"
            )
    lowercase_paths = [path.lower() for path in files]
    for path in files:
        if lowercase_paths.count(path.lower()) > 1:
            raise DefinitionError(path, "another file differs only in capital letters: rename one of them")
    own_messages = {path[4:-4] for path in files if path.startswith("msg/")}
    readers = {path: _Reader(package, path, text, own_messages) for path, text in sorted(files.items())}
    messages = {path[4:-4]: reader for path, reader in readers.items() if path.startswith("msg/")}
    elements = {path: reader.count_elements(messages, foreign or {}, ()) for path, reader in readers.items()}
    return tuple(Definition(path, r.sections, tuple(r.uses), elements[path]) for path, r in readers.items())


class _Reader:
    """Parses one file. `own_messages` contains the names of the package's messages."""

    def __init__(self, package: str, path: str, raw: str, own_messages: set[str]) -> None:
        self._package, self._path, self._own_messages = package, path, own_messages
        if len(raw.encode("utf-8", "replace")) > MAX_BYTES:
            raise DefinitionError(path, f"more than {MAX_BYTES // 1024} KiB: a definition is short")
        self._kind, name = path.split("/")
        self._name = name.rpartition(".")[0]
        lines = raw.replace("\r\n", "\n").split("\n")
        self._lines = [self._clean(line) for line in lines]
        self.uses: list[tuple[str, str, str]] = []
        # For each field: the number of its elements, its message type as package and name or None, and its line.
        self._arrays: list[tuple[int, tuple[str, str] | None, str]] = []
        self.sections = tuple(self._read_section(lines) for lines in self._split())

    def count_elements(
        self, messages: Mapping[str, _Reader], foreign: Mapping[tuple[str, str], int], outer_paths: tuple[str, ...]
    ) -> int:
        """Return the number of elements for which a new message of this type allocates memory.

        `outer_paths` are the definitions of the messages that contain it.
        """
        if self._path in outer_paths:
            raise self._error("the message contains itself: remove the field that leads back to it")
        total = 1
        for count, inner, line in self._arrays:
            inner_elements = 1
            if inner is not None and inner[0] == self._package:
                inner_elements = messages[inner[1]].count_elements(messages, foreign, (*outer_paths, self._path))
            elif inner is not None:
                inner_elements = foreign.get(inner, FOREIGN_ELEMENTS)
            total += count * inner_elements
            if total > MAX_ELEMENTS:
                raise self._error(
                    f"arrays of more than {MAX_ELEMENTS} elements in all: use fewer, or an unbounded array",
                    line,
                )
        return total

    def _error(self, problem: str, line: str = "") -> DefinitionError:
        return DefinitionError(self._path, problem, line)

    def _clean(self, line: str) -> str:
        code = line.replace("\t", " ").partition("#")[0].rstrip()
        if not _PRINTABLE.fullmatch(code):
            raise self._error("only plain ASCII characters are allowed outside comments", ascii(code))
        if "\\" in code:
            raise self._error("a backslash is not allowed in a definition: remove it", code)
        if code == "---" and line != "---":
            raise self._error("the separator --- must be alone on its line, without comment or space", line)
        return code

    def _split(self) -> list[list[str]]:
        sections: list[list[str]] = [[]]
        for line in self._lines:
            if line == "---":
                sections.append([])
            elif line:
                sections[-1].append(line)
        section_count = SECTIONS[self._kind]
        if len(sections) != section_count:
            advice = SEPARATOR_ADVICE[self._kind]
            problem = f"{len(sections) - 1} separator lines ---, but {section_count - 1} are needed: {advice}"
            raise self._error(problem)
        return sections

    def _read_section(self, lines: list[str]) -> Section:
        if len(lines) > MAX_FIELDS:
            raise self._error(f"more than {MAX_FIELDS} fields: use an array")
        names: set[str] = set()
        fields: list[Field] = []
        constants: list[Constant] = []
        for line in lines:
            if line.startswith(" "):
                raise self._error("the line begins with a space: remove it", line)
            spec = self._parse(line)
            for element in (*spec.fields, *spec.constants):
                if element.name in names:
                    raise self._error(f"{element.name} occurs twice: rename one", line)
                names.add(element.name)
            for constant in spec.constants:
                self._check_value(constant.value, line)
                constants.append(Constant(constant.name, str(constant.type), constant.value))
            for field in spec.fields:
                self._check_field(field, line)
                kind = field.type
                fields.append(
                    Field(
                        *(field.name, kind.type, kind.pkg_name, kind.string_upper_bound, bool(kind.is_array)),
                        *(kind.array_size, bool(kind.is_upper_bound), field.default_value),
                    )
                )
        section = Section(tuple(fields), tuple(constants))
        if not self._has_same_meaning(section):
            raise self._error("a string contains both kinds of quotation marks: use only one")
        return section

    def _has_same_meaning(self, section: Section) -> bool:
        """Return whether the lines generated from a section have the same meaning as the original ones."""
        spec = self._parse(str(section))
        values = [constant.value for constant in section.constants] + [field.default for field in section.fields]
        return values == [constant.value for constant in spec.constants] + [f.default_value for f in spec.fields]

    def _parse(self, line: str) -> Any:
        try:
            with contextlib.redirect_stderr(io.StringIO()):
                return rosidl.parser().parse_message_string(self._package, self._name, line)
        except Exception as error:  # the parser raises NameError, TypeError, ValueError and its own errors
            advice = "a field is written `type name`, a constant `type NAME=value`"
            reason = str(error)
            raise self._error(advice if reason == line else f"{reason} ({advice})", line) from None

    def _check_field(self, field: Any, line: str) -> None:
        if field.name in _C_WORDS or keyword.iskeyword(field.name):
            raise self._error(f"{field.name} is a reserved word of C or Python: give the field another name", line)
        kind = field.type
        if kind.type in ("time", "duration") and kind.pkg_name is None:
            new = kind.type.capitalize()
            raise self._error(f"ROS 2 has no {kind.type}: use builtin_interfaces/{new}", line)
        count = kind.array_size if kind.is_array and kind.array_size and not kind.is_upper_bound else 1
        inner = None if kind.pkg_name is None else (kind.pkg_name, kind.type)
        if kind.pkg_name == self._package:
            if kind.type not in self._own_messages:
                raise self._error(
                    f"there is no msg/{kind.type}.msg in {self._package}: write it, or correct the name", line
                )
        elif kind.pkg_name is not None:
            self.uses.append((kind.pkg_name, kind.type, line))
        self._arrays.append((count, inner, line))
        if field.default_value is not None:
            self._check_value(field.default_value, line)

    def _check_value(self, value: object, line: str) -> None:
        for element in value if isinstance(value, list) else [value]:
            if isinstance(element, float) and not math.isfinite(element):
                raise self._error("a value must be a finite number", line)
