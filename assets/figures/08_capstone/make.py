"""Draw the figures of chapter 08_capstone into its folder: `python assets/figures/08_capstone/make.py [FOLDER]`."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "08_capstone" / "figures"
HALF_HEIGHT = 0.24


@dataclass(frozen=True)
class Box:
    """A node or the robot, with the position of its centre."""

    name: str
    x: float
    y: float
    half_width: float = 1.1


ROBOT = Box("the robot", 0.0, 0.0, 0.75)
PROCESSOR = Box("sensor_processor", 3.1, 1.0)
CONTROLLER = Box("navigation_controller", 6.9, 1.0, 1.3)
MONITOR = Box("status_monitor", 5.0, -1.15)


def graph() -> Figure:
    """Return a figure of the system's graph: nodes as boxes, topics as arrows."""
    figure = Figure(figsize=(8.6, 3.9), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set(xlim=(-0.95, 9.65), ylim=(-2.2, 2.4), aspect="equal")
    ax.set_axis_off()
    _topic(ax, "scan", [(0.3, 0.24), (0.3, 1.0), (2.0, 1.0)], (0.95, 1.18))
    _topic(ax, "clearance", [(4.2, 1.0), (5.6, 1.0)], (4.9, 1.18))
    _topic(ax, "cmd_vel", [(6.9, 1.24), (6.9, 1.95), (-0.3, 1.95), (-0.3, 0.24)], (3.3, 2.13))
    from_scan = [(1.55, 1.0), (1.55, -0.95), (3.9, -0.95)]
    from_clearance = [(4.9, 1.0), (4.9, -0.91)]
    from_cmd_vel = [(6.9, 0.76), (6.9, -0.95), (6.1, -0.95)]
    for line in (from_scan, from_clearance, from_cmd_vel):
        _arrow(ax, line, LIGHT.muted)
    _topic(ax, "health", [(6.1, -1.3), (9.1, -1.3)], (7.7, -1.12))
    _topic(ax, "enable (service)", [(9.5, 1.0), (8.2, 1.0)], (8.95, 0.78))
    for box in (ROBOT, PROCESSOR, CONTROLLER, MONITOR):
        _box(ax, box)
    ax.text(3.9, -1.85, "grey: what the monitor listens to", color=LIGHT.muted, ha="left", va="center", fontsize=9)
    return figure


def _box(ax: Axes, box: Box) -> None:
    is_node = box is not ROBOT
    ax.add_patch(
        FancyBboxPatch(
            (box.x - box.half_width, box.y - HALF_HEIGHT),
            2 * box.half_width,
            2 * HALF_HEIGHT,
            boxstyle="round,pad=0.02,rounding_size=0.1",
            facecolor=LIGHT.paper if is_node else LIGHT.robot,
            edgecolor=LIGHT.robot,
            lw=1.8,
            zorder=5,
        )
    )
    colour = LIGHT.ink if is_node else LIGHT.paper
    ax.text(box.x, box.y, box.name, color=colour, ha="center", va="center", fontsize=10, zorder=6)


def _topic(ax: Axes, name: str, points: list[tuple[float, float]], label: tuple[float, float]) -> None:
    _arrow(ax, points, LIGHT.robot)
    ax.text(*label, name, color=LIGHT.hit, ha="center", va="center", fontsize=10)


def _arrow(ax: Axes, points: list[tuple[float, float]], colour: str) -> None:
    """Draw a line through the points, with a head at its end."""
    ax.plot(*zip(*points[:-1], strict=True), color=colour, lw=1.5, solid_capstyle="butt")
    ax.add_patch(
        FancyArrowPatch(points[-2], points[-1], arrowstyle="-|>", mutation_scale=13, shrinkA=0, shrinkB=0, color=colour)
    )


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        graph().savefig(folder / "graph.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
