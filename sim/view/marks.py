"""The styles of everything in a picture, which both Matplotlib and the player's canvas use.

Lengths are points (1/72 inch). Colours are names of fields of `sim.view.theme.Theme`. OWN is the robot's colour.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from sim.view.theme import LIGHT

OWN = "own"


@dataclass(frozen=True)
class Mark:
    """The style of one kind of object.

    Attributes:
        layer: the drawing order. Higher layers hide lower ones.
        fill: the colour of the inside, or "" for none.
        line: the colour of the line, or "" for none.
        width: the width of the line, in points.
        dash: the lengths of strokes and gaps in turn, in line widths; empty for a solid line.
        alpha: the opacity of fill and line.
        size: the diameter in points of a symbol, which has the same size in each world.
    """

    layer: float
    fill: str = ""
    line: str = ""
    width: float = 0.0
    dash: tuple[float, ...] = ()
    alpha: float = 1.0
    size: float = 0.0


MARKS: Mapping[str, Mark] = {
    "floor": Mark(0.3, fill="floor"),
    "grid": Mark(0.5, line="grid", width=0.7),
    "goal": Mark(1.0, fill="goal", alpha=0.12),
    "route": Mark(1.0, line="mover", width=1.0, dash=(1.0, 2.4)),
    "solid": Mark(1.2, fill="solid"),
    "seen": Mark(1.5, fill="beam", alpha=0.10),
    "goal ring": Mark(2.0, line="goal", width=1.4),
    "goal middle": Mark(2.0, fill="goal"),
    "start": Mark(2.0, line="start", width=1.1, dash=(2.2, 1.8)),
    "start nose": Mark(2.0, line="start", width=1.1),
    "ray": Mark(3.0, line="beam", width=0.5, alpha=0.45),
    "wall": Mark(4.0, line="wall", width=2.2),
    "pillar": Mark(4.0, fill="solid", line="wall", width=1.8),
    "track to come": Mark(4.8, line=OWN, width=1.3, alpha=0.35),
    "mover": Mark(5.0, fill="mover", line="paper", width=1.0, alpha=0.85),
    "track": Mark(5.0, line=OWN, width=2.6),
    "way ahead": Mark(5.5, line="ink", width=1.2, dash=(3.0, 2.4)),
    "hit": Mark(6.0, fill="hit", size=2.4),
    "closest": Mark(7.0, line="ink", width=1.2, dash=(2.0, 1.6)),
    "gap": Mark(7.0, line="alarm", width=1.4),
    "name": Mark(7.2, fill="muted", size=7.5),
    "halo": Mark(7.5, fill=OWN, alpha=0.16, size=24.0),
    "body": Mark(8.0, fill=OWN, line="paper", width=1.2),
    "nose": Mark(9.0, fill="paper"),
    "collision halo": Mark(10.0, line="paper", width=3.6, size=7.5),
    "instant": Mark(10.0, line="alarm", width=1.3, size=22.0),
    "collision": Mark(11.0, line="alarm", width=1.8, size=6.5),
    "closest end": Mark(12.0, fill="ink", size=4.5),
    "gap end": Mark(12.0, fill="alarm", size=4.5),
    "words": Mark(14.0, fill="ink", line="paper", width=3.0, size=8.5),
}
"""The style of each kind of object, by its name."""

MIDDLE = 0.18
"""The radius of the dot in a goal, as a share of the goal's radius."""

POINTER = 2.6
"""The length of the line that shows the heading of a start pose, in radii of the robot."""

BEAMS = 90
"""The approximate number of beams of a scan that are drawn as lines. Each hit is drawn as a point."""

PIECES = 48
"""The number of pieces in which a moving track is drawn, each in one colour."""

_STEPS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)

GRID = tuple((step, step * (14 if step >= 1.0 else 8)) for step in _STEPS)
"""Distances of grid lines, each with the largest extent for which it is used, in metres."""


def spacing_of(extent: float) -> float:
    """Return the distance of the grid lines for this extent; both are in metres."""
    return next((step for step, max_extent in GRID if extent <= max_extent), GRID[-1][0])


def to_json() -> str:
    """Return the styles as JSON, for the player."""
    look = {
        "marks": {name: asdict(mark) for name, mark in MARKS.items()},
        "grid": GRID,
        "middle": MIDDLE,
        "pointer": POINTER,
        "beams": BEAMS,
        "pieces": PIECES,
        "others": len(LIGHT.other_colours),
    }
    return json.dumps(look, separators=(",", ":"))
