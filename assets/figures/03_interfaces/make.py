"""Draw the figures of chapter 03_interfaces into its folder: `python assets/figures/03_interfaces/make.py [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "03_interfaces" / "figures"
CLIENT, SERVER = 0.0, 6.0  # the positions of the two lifelines


def generation() -> Figure:
    """Return a figure of the steps from a message definition to a Python class and its DDS type support."""
    figure, ax = _canvas(9.0, 2.5)
    _box(ax, 0.0, 0.0, 2.3, "RobotStatus.msg", "a text", LIGHT.robot)
    _box(ax, 3.4, 0.0, 2.6, "rosidl generators", "CMake calls them\nin colcon build", LIGHT.muted)
    _box(ax, 7.1, 0.75, 3.3, "RobotStatus", "a Python class to import", LIGHT.hit)
    _box(ax, 7.1, -0.75, 3.3, "type support", "C libraries that put it on DDS", LIGHT.hit)
    _arrow(ax, (2.35, 0.0), (3.35, 0.0), LIGHT.ink)
    _arrow(ax, (6.05, 0.1), (7.05, 0.7), LIGHT.ink)
    _arrow(ax, (6.05, -0.1), (7.05, -0.7), LIGHT.ink)
    ax.set(xlim=(-0.2, 10.6), ylim=(-1.5, 1.5))
    return figure


def action() -> Figure:
    """Return a figure of the messages between the client and the server of an action, from top to bottom."""
    figure, ax = _canvas(7.6, 4.6)
    for x, name in ((CLIENT, "client"), (SERVER, "server")):
        ax.text(x, 0.55, name, ha="center", color=LIGHT.ink, fontsize=11, weight="bold")
        ax.plot([x, x], [0.3, -7.3], color=LIGHT.muted, lw=1.2)
    messages = (
        (0.0, "goal: drive 2 m", True, LIGHT.robot),
        (-0.9, "accepted (or rejected: the end)", False, LIGHT.robot),
        (-2.2, "feedback: 0.4 m driven", False, LIGHT.muted),
        (-3.1, "feedback: 0.8 m driven", False, LIGHT.muted),
        (-4.3, "cancel request", True, LIGHT.hit),
        (-5.2, "cancel accepted", False, LIGHT.hit),
        (-6.6, "status CANCELED, and the result: 0.9 m", False, LIGHT.robot),
    )
    for y, text, to_server, colour in messages:
        ends = ((CLIENT + 0.05, y), (SERVER - 0.05, y))
        _arrow(ax, *(ends if to_server else ends[::-1]), colour)
        ax.text((CLIENT + SERVER) / 2, y + 0.13, text, ha="center", va="bottom", color=colour, fontsize=9)
    ax.add_patch(FancyBboxPatch((SERVER - 0.1, -6.6), 0.2, 5.5, boxstyle="square,pad=0", fc=LIGHT.robot, ec="none"))
    ax.text(SERVER + 0.3, -3.8, "execute(goal_handle)\nruns all this time", va="center", color=LIGHT.ink, fontsize=9)
    ax.set(xlim=(-0.8, 8.7), ylim=(-7.5, 1.0))
    return figure


def _canvas(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set_axis_off()
    return figure, ax


def _box(ax: Axes, x: float, y: float, width: float, title: str, words: str, colour: str) -> None:
    ax.add_patch(
        FancyBboxPatch((x, y - 0.55), width, 1.1, boxstyle="round,pad=0.02", fc=LIGHT.paper, ec=colour, lw=1.8)
    )
    ax.text(x + width / 2, y + 0.22, title, ha="center", va="center", color=LIGHT.ink, fontsize=10, weight="bold")
    ax.text(x + width / 2, y - 0.22, words, ha="center", va="center", color=LIGHT.ink, fontsize=8)


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    ax.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6})


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        for draw in (generation, action):
            draw().savefig(folder / f"{draw.__name__}.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
