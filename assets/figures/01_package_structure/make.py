"""Draw the figures of chapter 01_package_structure into its folder, or into the folder given as an argument."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from sim.view.theme import LIGHT, STYLE

FOLDER = Path(__file__).parents[3] / "chapters" / "01_package_structure" / "figures"
MONO = {"family": "DejaVu Sans Mono", "fontsize": 9, "va": "center", "color": LIGHT.ink}
PLAIN = {"fontsize": 9, "va": "center", "color": LIGHT.ink}
ROW = 0.5

# Each file of a package, and the tools that read it.
TREE = (
    ("square_dance/", ()),
    ("  package.xml", ("rosdep", "colcon")),
    ("  setup.py", ("colcon",)),
    ("  setup.cfg", ("colcon",)),
    ("  square_dance/", ("python",)),
    ("    nodes/dancer.py", ("python",)),
    ("    utils/steps.py", ("python",)),
    ("  resource/square_dance", ("ros2",)),
    ("  launch/*.launch.py", ("ros2",)),
    ("  config/*.yaml", ("ros2",)),
    ("  test/test_*.py", ("pytest",)),
)
READERS = {
    "rosdep": ("rosdep", "installs what the package needs", 0.8),
    "colcon": ("colcon build", "copies the package from src/ to install/", 2.7),
    "ros2": ("ros2 run, ros2 launch", "find the package, start its programs", 7.5),
    "python": ("Python", "imports the modules, runs main()", 5.0),
    "pytest": ("colcon test", "runs the tests", 9.8),
}

# The files that setup.py and setup.cfg install, and their destinations.
MOVES = (
    ("square_dance/nodes/dancer.py", "packages=find_packages(...)", "lib/python3.X/site-packages/square_dance/..."),
    ("dancer = square_dance.nodes.dancer:main", "entry_points, and setup.cfg", "lib/square_dance/dancer"),
    ("resource/square_dance", "data_files", "share/ament_index/resource_index/packages/..."),
    ("package.xml", "data_files", "share/square_dance/package.xml"),
    ("launch/*.launch.py", "data_files, glob", "share/square_dance/launch/"),
    ("config/*.yaml", "data_files, glob", "share/square_dance/config/"),
)


def readers() -> Figure:
    """Return a figure of the files of a package, with a line from each file to the tool that reads it."""
    figure, ax = _canvas(8.6, 4.9, (0.0, 15.0), (-0.7, 10.7 * ROW + 0.35))
    ys = {}
    for row, (name, _) in enumerate(TREE):
        ys[name] = 10 * ROW - row * ROW
        ax.text(0.2, ys[name], name, **MONO)
    for key, (title, description, row) in READERS.items():
        y = 10 * ROW - row * ROW
        _box(ax, 9.0, y, 5.8, 0.78)
        ax.text(9.25, y + 0.16, title, **(PLAIN | {"weight": "bold", "color": LIGHT.robot}))
        ax.text(9.25, y - 0.18, description, **PLAIN)
        for name, tools in TREE:
            if key in tools:
                start = 0.35 + 0.137 * len(name)
                ax.plot([start, 5.6, 8.95], [ys[name], ys[name], y], color=LIGHT.robot, lw=1.0, alpha=0.6)
    return figure


def installed_files() -> Figure:
    """Return a figure of the files that go from src to install, and what installs them in setup.py or setup.cfg."""
    figure, ax = _canvas(9.4, 3.6, (0.0, 20.0), (-0.5, 6.9 * 0.72))
    top = 6.2 * 0.72
    for x, text in ((0.2, "in src/square_dance"), (7.3, "is sent by"), (12.1, "to install/square_dance")):
        ax.text(x, top + 0.1, text, **(PLAIN | {"weight": "bold"}))
    for row, (source, setting, target) in enumerate(MOVES):
        y = top - 0.72 * (row + 1)
        ax.text(0.2, y, source, **(MONO | {"fontsize": 8}))
        _box(ax, 7.1, y, 4.2, 0.5)
        ax.text(7.3, y, setting, **(PLAIN | {"color": LIGHT.robot}))
        ax.annotate("", (12.0, y), (11.35, y), arrowprops={"arrowstyle": "->", "color": LIGHT.robot})
        ax.text(12.1, y, target, **(MONO | {"fontsize": 8}))
    return figure


def _canvas(width: float, height: float, x: tuple[float, float], y: tuple[float, float]) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), facecolor=LIGHT.paper)
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    ax.set(xlim=x, ylim=y)
    ax.set_axis_off()
    return figure, ax


def _box(ax: Axes, x: float, y: float, width: float, height: float) -> None:
    ax.add_patch(
        FancyBboxPatch(
            (x, y - height / 2),
            width,
            height,
            boxstyle="round,pad=0,rounding_size=0.1",
            facecolor=LIGHT.robot,
            edgecolor=LIGHT.robot,
            alpha=0.1,
        )
    )


def main(folder: Path = FOLDER) -> None:
    """Write each figure as SVG. The same code writes the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(dict(STYLE)):
        for name, draw in (("readers", readers), ("installed", installed_files)):
            draw().savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
