"""Reads and checks values in YAML nodes. The errors name the file and the line."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from sim.exceptions import WorldError
from sim.world import MAX_METRES

MAX_BYTES = 20_000_000
MAX_NAME = 200  # characters

LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
ANGLES = {"rad": 1.0, "deg": math.pi / 180.0}
NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-zA-Z]*)\s*")


@dataclass(frozen=True, slots=True)
class Units:
    """The default units of a file, for numbers that are written without a unit."""

    length: str = "m"
    angle: str = "rad"


def error_at(path: Path, node: yaml.Node, problem: str, remedy: str) -> WorldError:
    """Return an error that names the file and the line of a node."""
    return WorldError(problem, remedy, path=str(path), line=node.start_mark.line + 1)


def compose_file(path: Path) -> yaml.MappingNode:
    """Return the top-level mapping of a YAML file. Raise a WorldError if the file does not contain one."""
    name = str(path)
    try:
        data = path.read_bytes() if path.stat().st_size <= MAX_BYTES else None
    except OSError as error:
        raise WorldError(
            f"the file cannot be read ({error.strerror})", "Give the path of a world file", path=name
        ) from None
    if data is None:
        raise WorldError(f"the file is larger than {MAX_BYTES // 1_000_000} MB", "Give a smaller world", path=name)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise WorldError("the file is not UTF-8 text", "Save it as UTF-8", path=name, line=line) from None
    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = " ".join(f"{error.context or ''} {error.problem or ''}".split())
        remedy = "Correct the YAML here or just above; indent with spaces"
        raise WorldError(
            f"this is not YAML: {problem}", remedy, path=name, line=mark.line + 1 if mark else None
        ) from None
    except yaml.reader.ReaderError as error:
        line = text[: error.position].count("\n") + 1
        raise WorldError("a character that YAML does not allow", "Remove it", path=name, line=line) from None
    except (RecursionError, yaml.YAMLError, ValueError):
        raise WorldError("the file is nested too deeply to read", "Write a plain world file", path=name) from None
    if node is None:
        raise WorldError("the file is empty", "Give it walls, boxes, polygons or circles", path=name, line=1)
    if not isinstance(node, yaml.MappingNode):
        raise error_at(path, node, f"a world is a mapping, not {describe(node)}", "Begin with a line like `walls:`")
    return node


def describe(node: yaml.Node) -> str:
    """Describe a node for an error message."""
    if isinstance(node, yaml.MappingNode):
        return "a mapping"
    if isinstance(node, yaml.SequenceNode):
        return f"a list of {len(node.value)}"
    text = str(node.value)
    return f"{text[:40]!r}" if text else "nothing"


@dataclass(frozen=True, slots=True)
class Reader:
    """Reads values in the units of one file."""

    path: Path
    units: Units

    def fields(
        self, node: yaml.Node, label: str, required: Sequence[str] = (), optional: Sequence[str] = ()
    ) -> dict[str, yaml.Node]:
        """Return the fields of a mapping, which must have all required fields and may have the optional ones."""
        known_names = (*required, *optional)
        if not isinstance(node, yaml.MappingNode):
            raise error_at(
                self.path, node, f"{label} is {describe(node)}", f"Give a mapping with {_join_quoted(known_names)}"
            )
        fields_by_name: dict[str, yaml.Node] = {}
        for key, value in node.value:
            name = key.value if isinstance(key, yaml.ScalarNode) else describe(key)
            if name not in known_names:
                matches = difflib.get_close_matches(str(name), known_names, n=1)
                hint = f"Did you mean {matches[0]!r}?" if matches else f"It can have {_join_quoted(known_names)}"
                raise error_at(self.path, key, f"{label} has no field {str(name)[:40]!r}", hint)
            if name in fields_by_name:
                raise error_at(self.path, key, f"{label} has the field {name!r} twice", "Keep one of them")
            fields_by_name[name] = value
        missing_names = [name for name in required if name not in fields_by_name]
        if missing_names:
            raise error_at(self.path, node, f"{label} lacks {_join_quoted(missing_names)}", "Add it")
        return fields_by_name

    def items(self, node: yaml.Node | None, label: str, maximum: int, minimum: int = 0) -> list[yaml.Node]:
        """Return the `minimum` to `maximum` items of a list. A missing or empty section has no items."""
        if node is None or (minimum == 0 and _is_blank(node)):
            return []
        if not isinstance(node, yaml.SequenceNode):
            raise error_at(self.path, node, f"{label} is {describe(node)}", "Give a list")
        count = len(node.value)
        if not minimum <= count <= maximum:
            expected_text = f"{minimum} to {maximum}" if count > maximum else f"{minimum} or more"
            expected_text = f"{minimum}" if minimum == maximum else expected_text
            raise error_at(self.path, node, f"{label} is a list of {count}", f"Give {expected_text}")
        return list(node.value)

    def lengths(self, node: yaml.Node, label: str, count: int) -> tuple[float, ...]:
        """Return the `count` lengths of a list, in metres."""
        return tuple(self.length(item, label) for item in self.items(node, label, count, count))

    def length(self, node: yaml.Node, label: str) -> float:
        """Return a length in metres."""
        value = self._quantity(node, label, LENGTHS, self.units.length)
        if abs(value) > MAX_METRES:
            raise error_at(self.path, node, f"{label} is {value:g} m", f"Keep within {MAX_METRES:g} m; check the units")
        return value

    def positive_length(self, node: yaml.Node, label: str) -> float:
        """Return a length in metres that is above zero."""
        value = self.length(node, label)
        if value <= 0.0:
            raise error_at(self.path, node, f"{label} is {value:g} m", "Give a length above zero")
        return value

    def angle(self, node: yaml.Node, label: str) -> float:
        """Return an angle in radians, whose size may be at most 100."""
        value = self._quantity(node, label, ANGLES, self.units.angle)
        if abs(value) > 100.0:
            raise error_at(self.path, node, f"{label} is {value:g} rad", "Give an angle within a turn; check the units")
        return value

    def number(self, node: yaml.Node, label: str) -> float:
        """Return a plain number."""
        return self._quantity(node, label, {}, "")

    def text(self, node: yaml.Node | None, label: str) -> str:
        """Return a text of one line, or an empty text if the field is missing."""
        if node is None:
            return ""
        if not isinstance(node, yaml.ScalarNode):
            raise error_at(self.path, node, f"{label} is {describe(node)}", "Give a text")
        text = str(node.value)
        if len(text) > MAX_NAME or not text.isprintable():
            raise error_at(
                self.path, node, f"{label} is not a short text", f"Give one line of at most {MAX_NAME} characters"
            )
        return text

    def boolean(self, node: yaml.Node | None, label: str) -> bool:
        """Return a boolean, False if the field is missing."""
        return self.choice(node, label, ("true", "false"), "false", ignore_case=True) == "true"

    def choice(
        self, node: yaml.Node | None, label: str, choices: Sequence[str], default: str, *, ignore_case: bool = False
    ) -> str:
        """Return one of several words, or the default if the field is missing."""
        if node is None:
            return default
        value = node.value if isinstance(node, yaml.ScalarNode) else None
        value = str(value).lower() if ignore_case and value is not None else value
        if value not in choices:
            raise error_at(self.path, node, f"{label} is {describe(node)}", f"Give {' or '.join(choices)}")
        return str(value)

    def _quantity(self, node: yaml.Node, label: str, units: dict[str, float], unit: str) -> float:
        match = NUMBER.fullmatch(str(node.value)) if isinstance(node, yaml.ScalarNode) else None
        number, actual_unit = (float(match[1]), match[2] or unit) if match else (math.nan, unit)
        if not math.isfinite(number) or (actual_unit not in units and actual_unit != ""):
            expected_text = f"a number, in {' or '.join(units)}" if units else "a number"
            raise error_at(self.path, node, f"{label} is {describe(node)}", f"Give {expected_text}")
        return number * units.get(actual_unit, 1.0)


def _is_blank(node: yaml.Node) -> bool:
    return isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:null"


def _join_quoted(names: Sequence[Any]) -> str:
    quoted_names = [f"{name!r}" for name in names]
    return quoted_names[0] if len(quoted_names) == 1 else f"{', '.join(quoted_names[:-1])} and {quoted_names[-1]}"
