"""Draw the figures of chapter 06_testing into its folder: `python assets/figures/06_testing/make.py [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "06_testing" / "figures"
ROWS = (
    ("the code as it is", "wanted * share", "all pass", "as it should be", LIGHT.robot),
    ("mutant 1", "wanted * 1.0", "1 fails", "noticed", LIGHT.robot),
    ("mutant 2", "wanted * -share", "3 fail", "noticed", LIGHT.robot),
    ("mutant 3", "nan counts as clear", "all pass", "a hole in the tests", LIGHT.alarm),
)
TOP, STEP, HEIGHT = 3.55, 0.95, 0.7


def mutation() -> Figure:
    """Return a figure of mutation testing: the same tests run on the code and on copies with one fault each."""
    figure = Figure(figsize=(8.2, 4.2), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set(xlim=(0, 8.2), ylim=(0, 4.2))
    ax.set_axis_off()
    middle = TOP - 1.5 * STEP + HEIGHT / 2 - 0.35
    _box(ax, 3.55, middle - 0.6, 1.35, 1.2, "the same\ntests", LIGHT.ink)
    for row, (name, line, result, verdict, colour) in enumerate(ROWS):
        bottom = TOP - row * STEP - 0.35
        _box(ax, 0.1, bottom, 2.6, HEIGHT, f"{name}\n{line}", LIGHT.muted if row else LIGHT.ink)
        _arrow(ax, (2.72, bottom + HEIGHT / 2), (3.53, middle + (1.5 - row) * 0.3))
        _arrow(ax, (4.92, middle + (1.5 - row) * 0.3), (5.58, bottom + HEIGHT / 2))
        ax.text(5.66, bottom + HEIGHT / 2, result, color=LIGHT.ink, va="center", fontsize=11)
        ax.text(6.55, bottom + HEIGHT / 2, verdict, color=colour, va="center", fontsize=11, fontweight="bold")
    return figure


def _box(ax: Axes, x: float, y: float, width: float, height: float, text: str, colour: str) -> None:
    style = FancyBboxPatch((x, y), width, height, "round,pad=0,rounding_size=0.1", fc="none", ec=colour, lw=1.6)
    ax.add_patch(style)
    ax.text(x + width / 2, y + height / 2, text, color=LIGHT.ink, ha="center", va="center", fontsize=10.5)


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    ax.add_patch(FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=12, color=LIGHT.muted, lw=1.2))


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        mutation().savefig(folder / "mutation.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
