"""The world file's schema as JSON Schema, for editors and other tools; `load_world` checks the same and more."""

from __future__ import annotations

from typing import Any

_NUMBER = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*"


def world_schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of a world file."""
    length = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": _NUMBER + r"(m|cm|mm)?\s*$"}]}
    angle = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": _NUMBER + r"(rad|deg)?\s*$"}]}
    name = {"type": "string", "maxLength": 200}
    point = {"type": "array", "items": length, "minItems": 2, "maxItems": 2}
    wall = _mapping(["from", "to"], **{"name": name, "from": point, "to": point})
    bare_wall = {"type": "array", "items": length, "minItems": 4, "maxItems": 4}
    start = _mapping(["x", "y"], name=name, x=length, y=length, theta=angle)
    bare_start = {"type": "array", "prefixItems": [length, length, angle], "minItems": 3, "maxItems": 3}
    mover = _mapping(
        ["path"],
        name=name,
        path={"type": "array", "items": point, "minItems": 1},
        radius=length,
        speed=length,
        pause={"type": "number", "minimum": 0},
        loop={"type": "boolean"},
        phase={"type": "number", "minimum": 0, "maximum": 1},
    )
    world = _mapping(
        [],
        name=name,
        units=_mapping([], length={"enum": ["m", "cm", "mm"]}, angle={"enum": ["rad", "deg"]}),
        walls=_many({"anyOf": [wall, bare_wall]}),
        boxes=_many(_mapping(["size"], name=name, center=point, size=point)),
        polygons=_many(_mapping(["points"], name=name, points={"type": "array", "items": point, "minItems": 3})),
        circles=_many(_mapping(["center", "radius"], name=name, center=point, radius=length)),
        starts=_many({"anyOf": [start, bare_start]}),
        goals=_many(_mapping(["center"], name=name, center=point, radius=length)),
        movers=_many(mover),
    )
    heading = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A world of the 2D lidar simulator",
    }
    return {**heading, **world}


def _mapping(required: list[str], **properties: Any) -> dict[str, Any]:
    return {"type": "object", "additionalProperties": False, "required": required, "properties": properties}


def _many(item: dict[str, Any]) -> dict[str, Any]:
    return {"type": ["array", "null"], "items": item}
