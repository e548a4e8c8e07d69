"""Reads the YAML file of a ROS map by the rules of nav2's map_server. Errors name the line."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import yaml

from sim.exceptions import WorldError

MAX_BYTES = 100_000

MODES = ("trinary", "scale", "raw")
REQUIRED = ("image", "resolution", "origin", "occupied_thresh", "free_thresh", "negate")


@dataclass(frozen=True)
class MapFile:
    """The fields of a map_server YAML file. `image` is a full path, and `resolution` is in metres per cell.

    `origin` is the pose (m, m, rad) of the picture's lower left corner in the frame `map`. A cell is occupied above
    `occupied_thresh` and free below `free_thresh`, both from 0 to 1.
    """

    path: Path
    image: Path
    resolution: float
    origin: tuple[float, float, float]
    occupied_thresh: float
    free_thresh: float
    negate: bool
    mode: str


def read_map_file(path: Path) -> MapFile:
    """Read the YAML of a map.

    Raises:
        WorldError: the file cannot be read or is invalid.
    """
    fields = _Fields(path, _compose(path))
    fields.require(*REQUIRED)
    image = fields.text("image")
    mode = fields.text("mode", default="trinary")
    if mode not in MODES:
        raise fields.error("mode", f"the mode {mode!r} is unknown", f"Choose one of {', '.join(MODES)}")
    resolution = fields.number("resolution")
    if not 1e-4 <= resolution <= 100.0:
        raise fields.error(
            "resolution", f"a cell of {resolution:g} m is not usable", "Give metres per cell, such as 0.05"
        )
    occupied_thresh, free_thresh = fields.share("occupied_thresh"), fields.share("free_thresh")
    if free_thresh >= occupied_thresh:
        raise fields.error(
            "free_thresh",
            f"free_thresh {free_thresh:g} is not below occupied_thresh {occupied_thresh:g}",
            "Lower it; 0.25 is usual",
        )
    negate = fields.text("negate").lower()
    if negate not in ("0", "1", "true", "false"):
        raise fields.error("negate", f"negate is {negate!r}", "Write 0 (black is a wall) or 1 (white is a wall)")
    return MapFile(
        path=path,
        image=path.parent / image,
        resolution=resolution,
        origin=fields.triple("origin"),
        occupied_thresh=occupied_thresh,
        free_thresh=free_thresh,
        negate=negate in ("1", "true"),
        mode=mode,
    )


def is_map_file(path: Path) -> bool:
    """Return whether `path` is a readable YAML file with the key 'image', which only a map has."""
    try:
        node = _compose(path)
    except WorldError:
        return False
    return any(isinstance(key, yaml.ScalarNode) and key.value == "image" for key, _ in node.value)


def _compose(path: Path) -> yaml.MappingNode:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise WorldError("the file is larger than 100 kB", "Give a map's YAML, not its picture", path=str(path))
        node = yaml.compose(path.read_text(encoding="utf-8"), Loader=yaml.SafeLoader)
    except UnicodeDecodeError:
        raise WorldError("this is not a text file", "Give a map's YAML, not its picture", path=str(path)) from None
    except (OSError, ValueError) as error:
        raise WorldError(f"the file can't be read ({error})", "Correct the path", path=str(path)) from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else None
        raise WorldError(f"not YAML: {error.problem}", "Correct that line", path=str(path), line=line) from None
    except (yaml.YAMLError, RecursionError) as error:
        problem = str(error).splitlines()[0]
        raise WorldError(f"not YAML: {problem}", "Write 'key: value' lines", path=str(path)) from None
    if not isinstance(node, yaml.MappingNode):
        raise WorldError("no 'key: value' lines", "Give at least 'image:' and 'resolution:'", path=str(path), line=1)
    return node


class _Fields:
    """The top-level keys of a YAML file, with their lines."""

    def __init__(self, path: Path, node: yaml.MappingNode) -> None:
        self._path = path
        self._nodes: dict[str, yaml.Node] = {}
        for key, value in node.value:
            name = key.value if isinstance(key, yaml.ScalarNode) else "?"
            if name in self._nodes:
                raise WorldError(
                    f"{name!r} occurs twice", "Keep one", path=str(path), line=int(key.start_mark.line) + 1
                )
            self._nodes[name] = value

    def error(self, key: str, problem: str, remedy: str) -> WorldError:
        line = int(self._nodes[key].start_mark.line) + 1 if key in self._nodes else None
        return WorldError(problem, remedy, path=str(self._path), line=line)

    def require(self, *keys: str) -> None:
        missing_keys = [key for key in keys if key not in self._nodes]
        if missing_keys:
            raise self.error(
                "", f"{', '.join(repr(key) for key in missing_keys)} missing", "Add it, because map_server requires it"
            )

    def text(self, key: str, default: str = "") -> str:
        node = self._nodes.get(key)
        if node is None:
            return default
        if not isinstance(node, yaml.ScalarNode) or not node.value.strip() or "\0" in node.value:
            raise self.error(key, f"{key!r} is not one value", "Write one value after the colon")
        return str(node.value).strip()

    def number(self, key: str) -> float:
        return self._finite(key, self.text(key))

    def share(self, key: str) -> float:
        value = self.number(key)
        if not 0.0 <= value <= 1.0:
            raise self.error(key, f"{key} is {value:g}", "Give a share between 0 and 1")
        return value

    def triple(self, key: str) -> tuple[float, float, float]:
        node = self._nodes[key]
        items = node.value if isinstance(node, yaml.SequenceNode) else []
        if len(items) != 3 or not all(isinstance(item, yaml.ScalarNode) for item in items):
            raise self.error(key, f"{key!r} is not three numbers", "Write [x, y, yaw] in metres, metres and radians")
        x, y, yaw = (self._finite(key, item.value) for item in items)
        return x, y, yaw

    def _finite(self, key: str, text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            raise self.error(key, f"{text[:40]!r} of {key!r} is not a number", "Write a plain number") from None
        if not math.isfinite(value) or abs(value) > 1e6:
            raise self.error(key, f"{text[:40]} of {key!r} is not a usable number", "Write one within a million")
        return value
