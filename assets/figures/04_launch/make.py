"""Draw the figures of chapter 04_launch into its folder: `python assets/figures/04_launch/make.py [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "04_launch" / "figures"
MONO = "DejaVu Sans Mono"


def groups() -> Figure:
    """Return a figure of two robots from one launch file: each group's namespace, and the topic that they share."""
    figure = Figure(figsize=(8.6, 3.5), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set(xlim=(0, 8.6), ylim=(0, 3.5))
    ax.set_axis_off()
    for left, name in ((0.1, "robot1"), (5.3, "robot2")):
        _group(ax, left, name)
    _box(ax, 3.6, 0.5, 1.4, 0.5, "/fleet/status", LIGHT.hit)
    _arrow(ax, (2.75, 0.75), (3.6, 0.75), LIGHT.hit)
    _arrow(ax, (5.85, 0.75), (5.0, 0.75), LIGHT.hit)
    ax.text(4.3, 2.75, "one robot.launch.py,\nincluded twice", ha="center", va="center", fontsize=10, color=LIGHT.ink)
    return figure


def _group(ax: Axes, left: float, name: str) -> None:
    frame = FancyBboxPatch((left, 0.15), 3.2, 3.2, boxstyle="round,pad=0,rounding_size=0.12", fill=False, lw=1.6)
    frame.set_edgecolor(LIGHT.robot)
    ax.add_patch(frame)
    lines = (f"PushRosNamespace('{name}')", "SetRemap('status', '/fleet/status')", "robot.launch.py")
    for row, line in enumerate(lines):
        ax.text(left + 0.15, 3.1 - 0.24 * row, line, fontsize=8.5, family=MONO, color=LIGHT.muted, va="center")
    _box(ax, left + 0.55, 1.75, 2.1, 0.45, f"/{name}/driver", LIGHT.robot)
    _arrow(ax, (left + 1.6, 1.75), (left + 1.6, 0.98), LIGHT.robot)
    ax.text(left + 1.7, 1.37, f"/{name}/cmd_vel", fontsize=8.5, family=MONO, color=LIGHT.ink, va="center")
    _box(ax, left + 0.55, 0.53, 2.1, 0.45, f"/{name}/reporter", LIGHT.robot)


def _box(ax: Axes, x: float, y: float, width: float, height: float, text: str, colour: str) -> None:
    box = FancyBboxPatch((x, y), width, height, boxstyle="round,pad=0,rounding_size=0.1", lw=1.4)
    box.set(facecolor=LIGHT.paper, edgecolor=colour, zorder=3)
    ax.add_patch(box)
    ax.text(
        x + width / 2,
        y + height / 2,
        text,
        ha="center",
        va="center",
        fontsize=9,
        family=MONO,
        color=LIGHT.ink,
        zorder=4,
    )


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    ax.add_patch(FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=13, color=colour, lw=1.4, zorder=2))


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        groups().savefig(folder / "groups.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
