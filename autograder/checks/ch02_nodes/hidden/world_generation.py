"""Hidden worlds, drawn from the seed: each has named walls, and free space around the start."""

from __future__ import annotations

import math
import random

from sim import BOX_NAMES, Pose, World, box

FREE_RADIUS = 1.2  # m: the radius of the free space around the start
WALLS = [f"the {name}" for name in BOX_NAMES]
GAP = 1.4  # m between two obstacles, so that a robot fits through


def furnished_room(draw: random.Random) -> World:
    """Draw a rectangular room with a few pieces of furniture."""
    width, height = draw.uniform(6.5, 8.0), draw.uniform(5.0, 6.5)
    segments, names = box(width, height).tolist(), list(WALLS)
    for x, y in _places(draw, 3, width / 2 - 1.2, height / 2 - 1.2):
        wide, deep, name = draw.uniform(0.4, 0.9), draw.uniform(0.4, 0.9), draw.choice(("a table", "a shelf", "a sofa"))
        segments += box(wide, deep, x=x, y=y).tolist()
        names += [name] * 4
    return World.from_segments(segments, name="a furnished room", starts=[_start(draw)], segment_names=names)


def hall_of_pillars(draw: random.Random) -> World:
    """Draw a hall with round pillars."""
    width, height = draw.uniform(7.0, 8.5), draw.uniform(6.0, 7.5)
    circles = [(x, y, draw.uniform(0.12, 0.35)) for x, y in _places(draw, 6, width / 2 - 1.0, height / 2 - 1.0)]
    return World.from_segments(
        box(width, height).tolist(),
        circles=circles,
        name="a hall of pillars",
        starts=[_start(draw)],
        segment_names=WALLS,
        circle_names=["a pillar"] * len(circles),
    )


def bent_corridor(draw: random.Random) -> World:
    """Draw a corridor with one bend to the left, closed at both ends."""
    width, first, second = draw.uniform(2.2, 2.8), draw.uniform(5.0, 6.5), draw.uniform(4.0, 5.5)
    half = width / 2
    corners = [
        (-half, -half),
        (first + half, -half),
        (first + half, second),
        (first - half, second),
        (first - half, half),
        (-half, half),
    ]
    walls = [[*a, *b] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    names = ["the outer wall", "the outer wall", "the far end", "the inner wall", "the inner wall", "the near end"]
    start = Pose(draw.uniform(0.3, 0.8), draw.uniform(-0.2, 0.2), draw.uniform(-0.3, 0.3))
    return World.from_segments(walls, name="a bent corridor", starts=[start], segment_names=names)


def _start(draw: random.Random) -> Pose:
    return Pose(0.0, 0.0, draw.uniform(-math.pi, math.pi))


def _places(draw: random.Random, count: int, half_width: float, half_height: float) -> list[tuple[float, float]]:
    """Draw `count` places, or fewer if not all of them fit, that are apart from each other and from the start."""
    places: list[tuple[float, float]] = []
    for _ in range(60):
        x, y = draw.uniform(-half_width, half_width), draw.uniform(-half_height, half_height)
        if math.hypot(x, y) > FREE_RADIUS and all(math.hypot(x - a, y - b) > GAP for a, b in places):
            places.append((x, y))
        if len(places) == count:
            break
    return places
