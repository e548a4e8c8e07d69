"""Draw the figures of chapter 05_parameters into its folder: `python assets/figures/05_parameters/make.py [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "05_parameters" / "figures"
BOX, HEIGHT, STEP = 1.62, 1.0, 2.1  # the width and height of a box, and the distance between left edges
STEPS = (
    ("ROS checks", "declared? type?\nrange? read-only?", LIGHT.wall),
    ("validate", "do the values\nfit together?", LIGHT.robot),
    ("ROS stores", "all the values\nof the request", LIGHT.wall),
    ("apply", "act on them", LIGHT.robot),
)


def request() -> Figure:
    """Return a figure of the steps of a request to set parameters: two may reject it, and two carry it out."""
    figure = Figure(figsize=(8.6, 2.5), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set(xlim=(-2.3, 8.0), ylim=(-1.55, 1.45))
    ax.set_axis_off()
    ax.text(-2.2, 0.0, "one request:\nsafety_distance 1.5\nslow_distance 2.0", color=LIGHT.ink, fontsize=9, va="center")
    _arrow(ax, (-0.62, 0.0), (-0.06, 0.0), LIGHT.ink)
    for index, (title, description, colour) in enumerate(STEPS):
        left = index * STEP
        box = FancyBboxPatch(
            (left, -HEIGHT / 2), BOX, HEIGHT, boxstyle="round,pad=0,rounding_size=0.1", fc=LIGHT.paper, ec=colour, lw=2
        )
        ax.add_patch(box)
        text = {"ha": "center", "va": "center"}
        ax.text(left + BOX / 2, 0.27, title, color=colour, fontsize=10, fontweight="bold", **text)
        ax.text(left + BOX / 2, -0.16, description, color=LIGHT.ink, fontsize=8.5, **text)
        if index:
            _arrow(ax, (left - STEP + BOX + 0.06, 0.0), (left - 0.06, 0.0), LIGHT.ink)
        if index < 2:
            _arrow(ax, (left + BOX / 2, -0.56), (left + BOX / 2, -1.1), LIGHT.hit)
    ax.text(
        (STEP + BOX) / 2, -1.3, "refused, with a reason: nothing has changed", color=LIGHT.hit, fontsize=9, ha="center"
    )
    for index in (1, 3):
        ax.text(index * STEP + BOX / 2, 0.68, "yours", color=LIGHT.robot, fontsize=9, ha="center")
    return figure


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    ax.annotate(
        "", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
    )


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        request().savefig(folder / "request.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
