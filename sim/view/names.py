"""Places the names in a world: along walls, inside furniture and large pillars, and beside other pillars and goals."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim.view.shapes import Floats
from sim.world import World

MIN_RADIUS_FOR_NAME = 0.5
"""The minimum radius of a pillar whose name is written inside it, in metres."""

_ABOVE, _OUTSIDE, _INSIDE = 8.0, 8.0, 7.5
"""The distances in points of a name from a pillar or goal, from an outer wall, and from another wall."""


@dataclass(frozen=True)
class Name:
    """A text whose middle is `right` and `up` points from (`x`, `y`) in metres.

    `angle` is the direction of the text in radians, from the x axis to the left. `colour` is a field of a theme.
    """

    text: str
    x: float
    y: float
    right: float = 0.0
    up: float = 0.0
    angle: float = 0.0
    colour: str = "muted"


def names_of(world: World) -> list[Name]:
    """Return the names of walls, furniture, pillars and goals."""
    names = []
    for text in dict.fromkeys(filter(None, world.segment_names)):
        rows = world.segments[[index for index, other in enumerate(world.segment_names) if other == text]]
        if _is_closed(rows):
            x, y = rows.reshape(-1, 2).mean(axis=0).tolist()
            is_vertical = np.ptp(rows[:, 0::2]) < np.ptp(rows[:, 1::2])
            names.append(Name(text, x, y, angle=math.pi / 2 if is_vertical else 0.0))
        else:
            lengths = np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1])
            if lengths.max() > 0.0:
                names.append(_name_of_wall(text, rows[int(np.argmax(lengths))], world))
    for (x, y, radius), text in zip(world.circles.tolist(), world.circle_names, strict=True):
        if radius >= MIN_RADIUS_FOR_NAME:
            names.append(Name(text, x, y))
        elif text:
            names.append(Name(text, x, y + radius, up=_ABOVE))
    names += [Name(goal.name, goal.x, goal.y - goal.radius, up=-_ABOVE, colour="goal") for goal in world.goals]
    return [name for name in names if name.text]


def _name_of_wall(text: str, wall: Floats, world: World) -> Name:
    """Return a name along a wall (4,): outside an outer wall, and on the inner side of another one."""
    first, second = wall[:2], wall[2:]
    along = second - first
    if along[0] < 0 or (along[0] == 0 and along[1] < 0):
        along = -along
    centre = (first + second) / 2
    normal = np.array([-along[1], along[0]]) / float(np.hypot(*along))
    west, south, east, north = world.bounds
    inward = normal if normal @ ((west + east) / 2 - centre[0], (south + north) / 2 - centre[1]) >= 0 else -normal
    is_outer = centre[0] in (west, east) or centre[1] in (south, north)
    (x, y), (right, up) = centre.tolist(), ((-_OUTSIDE if is_outer else _INSIDE) * inward).tolist()
    return Name(text, x, y, right, up, angle=float(np.arctan2(along[1], along[0])))


def _is_closed(rows: Floats) -> bool:
    """Return whether the segments, in their order, form a closed outline, such as that of a piece of furniture."""
    return len(rows) > 2 and bool(np.allclose(rows[:, 2:], np.roll(rows[:, :2], -1, axis=0)))
