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
    for x, y in _draw_positions(draw, 3, width / 2 - 1.2, height / 2 - 1.2):
        item_width, item_depth = draw.uniform(0.4, 0.9), draw.uniform(0.4, 0.9)
        item_name = draw.choice(("a table", "a shelf", "a sofa"))
        segments += box(item_width, item_depth, x=x, y=y).tolist()
        names += [item_name] * 4
    return World.from_segments(segments, name="a furnished room", starts=[_draw_start(draw)], segment_names=names)


def hall_of_pillars(draw: random.Random) -> World:
    """Draw a hall with round pillars."""
    width, height = draw.uniform(7.0, 8.5), draw.uniform(6.0, 7.5)
    circles = [(x, y, draw.uniform(0.12, 0.35)) for x, y in _draw_positions(draw, 6, width / 2 - 1.0, height / 2 - 1.0)]
    return World.from_segments(
        box(width, height).tolist(),
        circles=circles,
        name="a hall of pillars",
        starts=[_draw_start(draw)],
        segment_names=WALLS,
        circle_names=["a pillar"] * len(circles),
    )


def bent_corridor(draw: random.Random) -> World:
    """Draw a corridor with one bend to the left, closed at both ends."""
    width, first_length, second_length = draw.uniform(2.2, 2.8), draw.uniform(5.0, 6.5), draw.uniform(4.0, 5.5)
    half_width = width / 2
    corners = [
        (-half_width, -half_width),
        (first_length + half_width, -half_width),
        (first_length + half_width, second_length),
        (first_length - half_width, second_length),
        (first_length - half_width, half_width),
        (-half_width, half_width),
    ]
    walls = [[*a, *b] for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
    names = ["the outer wall", "the outer wall", "the far end", "the inner wall", "the inner wall", "the near end"]
    start = Pose(draw.uniform(0.3, 0.8), draw.uniform(-0.2, 0.2), draw.uniform(-0.3, 0.3))
    return World.from_segments(walls, name="a bent corridor", starts=[start], segment_names=names)


def _draw_start(draw: random.Random) -> Pose:
    return Pose(0.0, 0.0, draw.uniform(-math.pi, math.pi))


def _draw_positions(
    draw: random.Random, count: int, half_width: float, half_height: float
) -> list[tuple[float, float]]:
    """Draw `count` positions that are apart from each other and from the start, or fewer if not all of them fit."""
    positions: list[tuple[float, float]] = []
    for _ in range(60):
        x, y = draw.uniform(-half_width, half_width), draw.uniform(-half_height, half_height)
        if math.hypot(x, y) > FREE_RADIUS and all(math.hypot(x - a, y - b) > GAP for a, b in positions):
            positions.append((x, y))
        if len(positions) == count:
            break
    return positions
