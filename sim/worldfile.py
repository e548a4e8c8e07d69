"""Reads a world from a YAML file, with errors that name the file, the line, the problem and a remedy.

    name: the room
    units: {length: m, angle: deg}          # or cm, mm; rad. A number can have its own: "30 cm"
    walls:
      - {name: shelf, from: [0, 0], to: [1.5, 0]}
      - [0, 0, 1.5, 0]                      # the same wall without a name
    boxes:                                  # four walls each: south, east, north, west
      - {center: [0, 0], size: [6, 4]}
    polygons:
      - {name: crate, points: [[1, 1], [2, 1], [2, 2]]}
    circles:
      - {name: pillar, center: [0, 1], radius: 0.2}
    starts:
      - {x: 0, y: 0, theta: 90}
    goals:
      - {name: door, center: [2, 1], radius: 0.3}
    movers:
      - {name: cart, path: [[0, 0], [2, 0]], radius: 0.2, speed: 0.3, pause: 1, loop: false}

Every section is optional.
"""

from __future__ import annotations

import math
from pathlib import Path

import yaml

from sim.exceptions import WorldError
from sim.fields import Reader, Units, compose_file, error_at
from sim.pose import Pose
from sim.world import BOX_NAMES, Goal, Mover, World, box

MAX_THINGS = 200_000  # in a section
MAX_MOVERS = 1000


def load_world(path: str | Path) -> World:
    """Read a world file. Raise a WorldError, which names the line, if it is not a valid world."""
    file = Path(path)
    top = compose_file(file)
    if any(key.value == "image" for key, _ in top.value if isinstance(key, yaml.ScalarNode)):
        raise error_at(file, top, "this is a map of ROS's map_server, not a world", "Load it with sim.maps.load_map")
    metre_reader = Reader(file, Units())
    sections = metre_reader.fields(
        top,
        "the world",
        optional=("name", "units", "walls", "boxes", "polygons", "circles", "starts", "goals", "movers"),
    )
    read = Reader(file, _units(metre_reader, sections.get("units")))
    name = read.text(sections.get("name"), "name")
    segments: list[tuple[float, float, float, float]] = []
    names: list[str] = []
    for node in read.items(sections.get("walls"), "walls", MAX_THINGS):
        if isinstance(node, yaml.SequenceNode):
            x1, y1, x2, y2 = read.lengths(node, "a wall", 4)
            label = ""
        else:
            wall = read.fields(node, "a wall", required=("from", "to"), optional=("name",))
            (x1, y1), (x2, y2) = read.lengths(wall["from"], "from", 2), read.lengths(wall["to"], "to", 2)
            label = read.text(wall.get("name"), "name")
        if (x1, y1) == (x2, y2):
            raise error_at(
                file, node, "the wall has no length: it ends where it begins", "Move one end, or leave it out"
            )
        segments.append((x1, y1, x2, y2))
        names.append(label)
    for node in read.items(sections.get("boxes"), "boxes", MAX_THINGS):
        room = read.fields(node, "a box", required=("size",), optional=("center", "name"))
        width, height = (read.positive_length(value, "size") for value in read.items(room["size"], "size", 2, 2))
        x, y = read.lengths(room["center"], "center", 2) if "center" in room else (0.0, 0.0)
        prefix = read.text(room.get("name"), "name")
        segments += [(a, b, c, d) for a, b, c, d in box(width, height, x=x, y=y).tolist()]
        names += [f"{prefix} {side}".strip() for side in BOX_NAMES]
    for node in read.items(sections.get("polygons"), "polygons", MAX_THINGS):
        polygon = read.fields(node, "a polygon", required=("points",), optional=("name",))
        sides = _sides(read, polygon["points"])
        segments += sides
        names += [read.text(polygon.get("name"), "name")] * len(sides)
    if len(segments) > MAX_THINGS:
        raise error_at(file, top, f"there are {len(segments)} walls in all", f"Keep to {MAX_THINGS}")
    circles, circle_names = [], []
    for node in read.items(sections.get("circles"), "circles", MAX_THINGS):
        circle = read.fields(node, "a circle", required=("center", "radius"), optional=("name",))
        circles.append((*read.lengths(circle["center"], "center", 2), read.positive_length(circle["radius"], "radius")))
        circle_names.append(read.text(circle.get("name"), "name"))
    starts = [_start(read, node, circles) for node in read.items(sections.get("starts"), "starts", MAX_MOVERS)]
    goals = [_goal(read, node) for node in read.items(sections.get("goals"), "goals", MAX_MOVERS)]
    movers = [_mover(read, node) for node in read.items(sections.get("movers"), "movers", MAX_MOVERS)]
    if not (segments or circles or movers):
        raise error_at(file, top, "the world is empty", "Give it walls, boxes, polygons, circles or movers")
    return World.from_segments(
        segments,
        circles=circles,
        name=name or file.stem,
        starts=starts or (Pose(),),
        goals=goals,
        movers=movers,
        segment_names=names,
        circle_names=circle_names,
    )


def _units(read: Reader, node: yaml.Node | None) -> Units:
    if node is None:
        return Units()
    given_fields = read.fields(node, "units", optional=("length", "angle"))
    return Units(
        length=read.choice(given_fields.get("length"), "length", ("m", "cm", "mm"), "m"),
        angle=read.choice(given_fields.get("angle"), "angle", ("rad", "deg"), "rad"),
    )


def _sides(read: Reader, node: yaml.Node) -> list[tuple[float, float, float, float]]:
    nodes = read.items(node, "points", MAX_THINGS, 3)
    points = [read.lengths(point, "a point", 2) for point in nodes]
    if points[0] == points[-1]:  # the file repeats the first point at the end
        points.pop()
    for point, first, second in zip(nodes[1:], points, points[1:], strict=False):
        if first == second:
            raise error_at(read.path, point, "two neighbouring points are the same", "Leave one of them out")
    if len(points) < 3:
        raise error_at(read.path, node, f"a polygon of {len(points)} points", "Give three or more, or use a wall")
    return [(a[0], a[1], b[0], b[1]) for a, b in zip(points, points[1:] + points[:1], strict=True)]


def _start(read: Reader, node: yaml.Node, circles: list[tuple[float, ...]]) -> Pose:
    if isinstance(node, yaml.SequenceNode):
        x_node, y_node, theta_node = read.items(node, "a start pose [x, y, theta]", 3, 3)
        pose = Pose(read.length(x_node, "x"), read.length(y_node, "y"), read.angle(theta_node, "theta"))
    else:
        start = read.fields(node, "a start pose", required=("x", "y"), optional=("theta", "name"))
        theta = read.angle(start["theta"], "theta") if "theta" in start else 0.0
        pose = Pose(read.length(start["x"], "x"), read.length(start["y"], "y"), theta)
    for number, (x, y, radius) in enumerate(circles):
        if math.hypot(pose.x - x, pose.y - y) < radius:
            raise error_at(read.path, node, f"the start pose is inside the circle {number}", "Move one of the two")
    return pose


def _goal(read: Reader, node: yaml.Node) -> Goal:
    goal = read.fields(node, "a goal", required=("center",), optional=("radius", "name"))
    x, y = read.lengths(goal["center"], "center", 2)
    radius = read.positive_length(goal["radius"], "radius") if "radius" in goal else 0.25
    return Goal(x, y, radius, read.text(goal.get("name"), "name") or "goal")


def _mover(read: Reader, node: yaml.Node) -> Mover:
    mover = read.fields(
        node,
        "a mover",
        required=("path",),
        optional=("radius", "speed", "pause", "loop", "phase", "name"),
    )
    points = read.items(mover["path"], "path", 10_000, 1)
    given_fields = {
        "radius": read.length(mover["radius"], "radius") if "radius" in mover else 0.2,
        "speed": read.length(mover["speed"], "speed") if "speed" in mover else 0.3,
        "pause": read.number(mover["pause"], "pause") if "pause" in mover else 0.0,
        "phase": read.number(mover["phase"], "phase") if "phase" in mover else None,
    }
    try:
        return Mover(
            path=tuple(read.lengths(point, "a point of the path", 2) for point in points),  # type: ignore[misc]
            loop=read.boolean(mover.get("loop"), "loop"),
            name=read.text(mover.get("name"), "name") or "mover",
            **given_fields,  # type: ignore[arg-type]
        )
    except WorldError as error:
        if error.line is not None:
            raise
        raise error_at(read.path, node, error.problem, error.remedy) from None
