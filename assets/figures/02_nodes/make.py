"""Draw the figures of chapter 02_nodes into its folder: `python assets/figures/02_nodes/make.py [FOLDER]`."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Wedge

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "02_nodes" / "figures"
HALF_SECTOR = 30.0  # degrees
SAFETY_DISTANCE = 1.0  # m
ROBOT = 0.105  # m
WALLS = (((0.72, -0.62), (0.72, 0.38)), ((-0.5, 0.62), (0.45, 0.62)))


def sector() -> Figure:
    """Return a figure of the forward sector seen from above, with the beams in it and the walls that count."""
    figure = Figure(figsize=(7.6, 4.82), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set(xlim=(-1.72, 2.0), ylim=(-1.18, 1.18), aspect="equal")
    ax.set_axis_off()
    ax.add_patch(Wedge((0, 0), SAFETY_DISTANCE, -HALF_SECTOR, HALF_SECTOR, color=LIGHT.robot, alpha=0.14, lw=0))
    for (x1, y1), (x2, y2) in WALLS:
        ax.plot([x1, x2], [y1, y2], color=LIGHT.wall, lw=4)
    for degrees in range(0, 360, 10):
        _beam(ax, math.radians(degrees))
    for side in (HALF_SECTOR, -HALF_SECTOR):
        x, y = 1.18 * math.cos(math.radians(side)), 1.18 * math.sin(math.radians(side))
        ax.plot([0, x], [0, y], color=LIGHT.robot, lw=1.2, ls=(0, (4, 3)))
        ax.text(
            x + 0.04, y, f"{side:+.0f}° = {math.radians(side):+.2f} rad", color=LIGHT.robot, va="center", fontsize=9
        )
    ax.add_patch(Circle((0, 0), ROBOT, facecolor=LIGHT.robot, edgecolor=LIGHT.paper, lw=1.5, zorder=5))
    ax.plot([0.03, ROBOT], [0, 0], color=LIGHT.paper, lw=2.5, zorder=6)
    _labels(ax)
    return figure


def _beam(ax: Axes, bearing: float) -> None:
    """Draw one beam, up to the first wall or at full length. Beams that count are drawn more strongly."""
    reach = min([1.0, *(r for r in (_range(wall, bearing) for wall in WALLS) if r is not None)])
    counts = abs(math.remainder(bearing, math.tau)) <= math.radians(HALF_SECTOR) + 1e-9
    colour, alpha = (LIGHT.hit, 1.0) if counts else (LIGHT.muted, 0.35)
    x, y = reach * math.cos(bearing), reach * math.sin(bearing)
    ax.plot([0, x], [0, y], color=colour, alpha=alpha, lw=1.1)
    if reach < 1.0:
        ax.plot([x], [y], "o", color=colour, alpha=alpha, ms=3.5)


def _range(wall: tuple[tuple[float, float], tuple[float, float]], bearing: float) -> float | None:
    """Return the distance at which a ray from the origin meets a wall, or None."""
    start, end = np.array(wall[0]), np.array(wall[1])
    ray, along = np.array([math.cos(bearing), math.sin(bearing)]), end - start
    det = ray[1] * along[0] - ray[0] * along[1]
    if abs(det) < 1e-12:
        return None
    distance = (start[1] * along[0] - start[0] * along[1]) / det
    fraction = (ray[0] * start[1] - ray[1] * start[0]) / det
    return float(distance) if distance > 0 and 0 <= fraction <= 1 else None


def _labels(ax: Axes) -> None:
    ink = {"color": LIGHT.ink, "fontsize": 9, "va": "center"}
    ax.text(1.12, 0.0, "bearing 0: forward (+x)", ha="left", **ink)
    ax.text(0.0, 1.1, "bearing $+\\pi/2$: left (+y)", ha="center", **ink)
    ax.text(0.0, -1.1, "bearing $-\\pi/2$: right", ha="center", **ink)
    ax.text(-1.04, 0.0, "bearing $\\pi$: behind", ha="right", **ink)
    ax.text(0.8, -0.74, "this wall is in front,\nnearer than 1 m: turn", ha="left", **(ink | {"color": LIGHT.hit}))
    ax.text(-0.52, 0.72, "this wall is beside:\nit does not count", ha="left", **(ink | {"color": LIGHT.muted}))


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        sector().savefig(folder / "sector.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
