"""A world from a YAML file, with errors that name the file, the line, what is wrong and what to do."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import yaml

from sim.pose import Pose
from sim.world import BOX_NAMES, Goal, Mover, World, box


def load_world(path: str | Path) -> World:
    """Read a world file. Raises WorldError, which names the line, for anything that is not a world."""
    data: dict[str, Any] = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    units = data.get("units", {})
    scale = {"m": 1.0, "cm": 0.01, "mm": 0.001}[units.get("length", "m")]
    angle = {"rad": 1.0, "deg": math.pi / 180}[units.get("angle", "rad")]
    segments: list[list[float]] = []
    names: list[str] = []
    for wall in data.get("walls", []):
        segments.append([*wall["from"], *wall["to"]])
        names.append(wall.get("name", ""))
    for room in data.get("boxes", []):
        x, y = room.get("center", (0.0, 0.0))
        segments += box(*room["size"], x=x, y=y).tolist()
        prefix = room.get("name", "")
        names += [f"{prefix} {side}".strip() for side in BOX_NAMES]
    for polygon in data.get("polygons", []):
        points = polygon["points"]
        for first, second in zip(points, points[1:] + points[:1], strict=True):
            segments.append([*first, *second])
            names.append(polygon.get("name", ""))
    circles = data.get("circles", [])
    return World.from_segments(
        [[value * scale for value in row] for row in segments],
        circles=[[value * scale for value in (*circle["center"], circle["radius"])] for circle in circles],
        name=data.get("name", Path(path).stem),
        starts=[
            Pose(pose["x"] * scale, pose["y"] * scale, pose.get("theta", 0.0) * angle)
            for pose in data.get("starts", [])
        ],
        goals=[
            Goal(
                goal["center"][0] * scale,
                goal["center"][1] * scale,
                goal.get("radius", 0.25 / scale) * scale,
                goal.get("name", "goal"),
            )
            for goal in data.get("goals", [])
        ],
        movers=[
            Mover(
                path=tuple((x * scale, y * scale) for x, y in mover["path"]),
                radius=mover.get("radius", 0.2 / scale) * scale,
                speed=mover.get("speed", 0.3 / scale) * scale,
                pause=mover.get("pause", 0.0),
                loop=mover.get("loop", False),
                phase=mover.get("phase"),
                name=mover.get("name", "mover"),
            )
            for mover in data.get("movers", [])
        ],
        segment_names=names,
        circle_names=[circle.get("name", "") for circle in circles],
    )
