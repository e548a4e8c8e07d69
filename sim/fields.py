"""Values out of YAML nodes: each reader checks what it reads, and its error names the file and the line."""

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
MAX_NAME = 200

LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
ANGLES = {"rad": 1.0, "deg": math.pi / 180.0}
NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([a-zA-Z]*)\s*")


@dataclass(frozen=True, slots=True)
class Units:
    """What a bare number means in a file."""

    length: str = "m"
    angle: str = "rad"


def bad(path: Path, node: yaml.Node, problem: str, remedy: str) -> WorldError:
    """Return the error about a node of a file."""
    return WorldError(problem, remedy, path=str(path), line=node.start_mark.line + 1)


def composed(path: Path) -> yaml.MappingNode:
    """Return the nodes of a YAML file that is one mapping. Raises WorldError for anything else."""
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
        raise WorldError("a character that YAML does not allow", "Take it out", path=name, line=line) from None
    except (RecursionError, yaml.YAMLError, ValueError):
        raise WorldError("the file is nested too deeply to read", "Write a plain world file", path=name) from None
    if node is None:
        raise WorldError("the file is empty", "Give it walls, boxes, polygons or circles", path=name, line=1)
    if not isinstance(node, yaml.MappingNode):
        raise bad(path, node, f"a world is a mapping, not {kind(node)}", "Begin with a line like `walls:`")
    return node


def kind(node: yaml.Node) -> str:
    """Say in words what a node is."""
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
        self, node: yaml.Node, what: str, required: Sequence[str] = (), optional: Sequence[str] = ()
    ) -> dict[str, yaml.Node]:
        """Return the fields of a mapping: all the required ones, and no other than these."""
        known = (*required, *optional)
        if not isinstance(node, yaml.MappingNode):
            raise bad(self.path, node, f"{what} is {kind(node)}", f"Give a mapping with {_list(known)}")
        found: dict[str, yaml.Node] = {}
        for key, value in node.value:
            name = key.value if isinstance(key, yaml.ScalarNode) else kind(key)
            if name not in known:
                near = difflib.get_close_matches(str(name), known, n=1)
                hint = f"Did you mean {near[0]!r}?" if near else f"It can have {_list(known)}"
                raise bad(self.path, key, f"{what} has no field {str(name)[:40]!r}", hint)
            if name in found:
                raise bad(self.path, key, f"{what} has the field {name!r} twice", "Keep one of them")
            found[name] = value
        missing = [name for name in required if name not in found]
        if missing:
            raise bad(self.path, node, f"{what} lacks {_list(missing)}", "Add it")
        return found

    def items(self, node: yaml.Node | None, what: str, most: int, least: int = 0) -> list[yaml.Node]:
        """Return the items of a list of `least` to `most`; none for a section that is left out or left blank."""
        if node is None or (least == 0 and _blank(node)):
            return []
        if not isinstance(node, yaml.SequenceNode):
            raise bad(self.path, node, f"{what} is {kind(node)}", "Give a list")
        count = len(node.value)
        if not least <= count <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}" if count > most else f"{least} or more"
            raise bad(self.path, node, f"{what} is a list of {count}", f"Give {wanted}")
        return list(node.value)

    def lengths(self, node: yaml.Node, what: str, count: int) -> tuple[float, ...]:
        """Return `count` lengths in metres out of a list."""
        return tuple(self.length(item, what) for item in self.items(node, what, count, count))

    def length(self, node: yaml.Node, what: str) -> float:
        """Return a length in metres."""
        value = self._quantity(node, what, LENGTHS, self.units.length)
        if abs(value) > MAX_METRES:
            raise bad(self.path, node, f"{what} is {value:g} m", f"Keep within {MAX_METRES:g} m; mind the units")
        return value

    def above_zero(self, node: yaml.Node, what: str) -> float:
        """Return a length in metres that is above zero."""
        value = self.length(node, what)
        if value <= 0.0:
            raise bad(self.path, node, f"{what} is {value:g} m", "Give a length above zero")
        return value

    def angle(self, node: yaml.Node, what: str) -> float:
        """Return an angle in radians, within some turns of zero."""
        value = self._quantity(node, what, ANGLES, self.units.angle)
        if abs(value) > 100.0:
            raise bad(self.path, node, f"{what} is {value:g} rad", "Give an angle within a turn; mind the units")
        return value

    def number(self, node: yaml.Node, what: str) -> float:
        """Return a plain number."""
        return self._quantity(node, what, {}, "")

    def text(self, node: yaml.Node | None, what: str) -> str:
        """Return a text on one line; an empty one for a field that is left out."""
        if node is None:
            return ""
        if not isinstance(node, yaml.ScalarNode):
            raise bad(self.path, node, f"{what} is {kind(node)}", "Give a text")
        text = str(node.value)
        if len(text) > MAX_NAME or not text.isprintable():
            raise bad(self.path, node, f"{what} is not a short text", f"Give one line of at most {MAX_NAME} characters")
        return text

    def truth(self, node: yaml.Node | None, what: str) -> bool:
        """Return true or false; false for a field that is left out."""
        return self.choice(node, what, ("true", "false"), "false", plain=True) == "true"

    def choice(
        self, node: yaml.Node | None, what: str, choices: Sequence[str], default: str, *, plain: bool = False
    ) -> str:
        """Return one of some words, `plain` ones whatever their case."""
        if node is None:
            return default
        value = node.value if isinstance(node, yaml.ScalarNode) else None
        value = str(value).lower() if plain and value is not None else value
        if value not in choices:
            raise bad(self.path, node, f"{what} is {kind(node)}", f"Give {' or '.join(choices)}")
        return str(value)

    def _quantity(self, node: yaml.Node, what: str, units: dict[str, float], unit: str) -> float:
        match = NUMBER.fullmatch(str(node.value)) if isinstance(node, yaml.ScalarNode) else None
        number, given = (float(match[1]), match[2] or unit) if match else (math.nan, unit)
        if not math.isfinite(number) or (given not in units and given != ""):
            wanted = f"a number, in {' or '.join(units)}" if units else "a number"
            raise bad(self.path, node, f"{what} is {kind(node)}", f"Give {wanted}")
        return number * units.get(given, 1.0)


def _blank(node: yaml.Node) -> bool:
    return isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:null"


def _list(names: Sequence[Any]) -> str:
    quoted = [f"{name!r}" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} and {quoted[-1]}"
