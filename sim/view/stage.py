"""Prepares the Axes of a picture: its size, title, names and legend."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sim.view.artists import set_stage
from sim.view.shapes import margin_of
from sim.view.theme import Theme
from sim.world import World

WIDTH = 7.6
HEIGHT = 5.4
"""The maximum size of a picture in inches."""

_LEFT, _RIGHT, _BOTTOM, _TOP = 0.42, 0.16, 0.34, 0.60
"""The margins around the axes in inches."""

MIN_RADIUS_FOR_NAME = 0.5
"""The minimum radius of a pillar whose name is written inside it, in metres."""


def new_axes(world: World, theme: Theme) -> Axes:
    """Return the Axes of a new Figure of at most `WIDTH` x `HEIGHT` inches, in the proportions of the world."""
    left, low, right, high = world.bounds
    margin = 2 * margin_of(world)
    across, up = max(right - left, 0.1) + margin, max(high - low, 0.1) + margin
    scale = min((WIDTH - _LEFT - _RIGHT) / across, (HEIGHT - _BOTTOM - _TOP) / up)
    width, height = max(across * scale, 3.2), up * scale
    sheet = (width + _LEFT + _RIGHT, height + _BOTTOM + _TOP)
    figure = Figure(figsize=sheet, facecolor=theme.paper)
    box = (_LEFT / sheet[0], _BOTTOM / sheet[1], width / sheet[0], height / sheet[1])
    return figure.add_axes(box)


def prepare(ax: Axes, world: World, theme: Theme, title: str, subtitle: str) -> None:
    """Set limits, grid and ticks, and write the two lines of the heading."""
    set_stage(ax, world, theme)
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points", "annotation_clip": False}
    ax.annotate(title, (0, 1), (0, 21), fontsize=12.5, fontweight="bold", color=theme.ink, va="baseline", **place)
    ax.annotate(subtitle, (0, 1), (0, 7), fontsize=9, color=theme.muted, va="baseline", **place)


def add_scale(ax: Axes, colours: Any, limits: tuple[float, float], unit: str, label: str, theme: Theme) -> None:
    """Draw a narrow colour scale at the top right of `ax`, with labels at both ends."""
    height = ax.get_window_extent().height / ax.figure.dpi * 72
    width = ax.get_window_extent().width / ax.figure.dpi * 72
    bar = ax.inset_axes((1 - 110 / width, 1 + 9 / height, 110 / width, 4 / height))
    bar.imshow(np.linspace(0, 1, 128)[None, :], aspect="auto", cmap=colours, extent=(0, 1, 0, 1))
    bar.set_axis_off()
    place: dict[str, Any] = {
        "xycoords": "axes fraction",
        "textcoords": "offset points",
        "annotation_clip": False,
        "fontsize": 8,
    }
    for x, text, side in ((0, f"{limits[0]:.3g}", "left"), (1, f"{limits[1]:.3g} {unit}", "right")):
        bar.annotate(text, (x, 1), (0, 3), ha=side, va="bottom", color=theme.muted, **place)
    bar.annotate(label, (0.5, 1), (0, 3), ha="center", va="bottom", color=theme.muted, **place)


def write_names(ax: Axes, world: World, theme: Theme) -> None:
    """Write names: along walls, inside furniture and large pillars, and beside other pillars and goals."""
    style: dict[str, Any] = {"fontsize": 7.5, "color": theme.muted, "zorder": 7, "annotation_clip": False}
    for name in dict.fromkeys(filter(None, world.segment_names)):
        rows = world.segments[[index for index, other in enumerate(world.segment_names) if other == name]]
        if _is_closed(rows):
            centre = rows.reshape(-1, 2).mean(axis=0)
            is_vertical = np.ptp(rows[:, 0::2]) < np.ptp(rows[:, 1::2])
            ax.annotate(name, tuple(centre), ha="center", va="center", rotation=90 if is_vertical else 0, **style)
            continue
        wall = rows[int(np.argmax(np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1])))]
        _name_wall(ax, name, wall, world, style)
    for (x, y, radius), name in zip(world.circles.tolist(), world.circle_names, strict=True):
        if radius >= MIN_RADIUS_FOR_NAME:
            ax.annotate(name, (x, y), ha="center", va="center", **style)
        elif name:
            ax.annotate(name, (x, y + radius), (0, 4), textcoords="offset points", ha="center", va="bottom", **style)
    for goal in world.goals:
        spot = (goal.x, goal.y - goal.radius)
        style_goal: dict[str, Any] = {**style, "color": theme.goal}
        ax.annotate(goal.name, spot, (0, -4), textcoords="offset points", ha="center", va="top", **style_goal)


def _name_wall(ax: Axes, name: str, wall: npt.NDArray[Any], world: World, style: dict[str, Any]) -> None:
    first, second = wall[:2], wall[2:]
    along = second - first
    if along[0] < 0 or (along[0] == 0 and along[1] < 0):
        along = -along
    length = float(np.hypot(*along))
    if length == 0.0:
        return
    centre = (first + second) / 2
    normal = np.array([-along[1], along[0]]) / length
    left, low, right, high = world.bounds
    middle = np.array([(left + right) / 2, (low + high) / 2])
    inward = normal if normal @ (middle - centre) >= 0 else -normal
    is_outer = centre[0] in (left, right) or centre[1] in (low, high)
    angle = float(np.degrees(np.arctan2(along[1], along[0])))
    ax.annotate(
        name,
        tuple(centre),
        tuple(-8.0 * inward if is_outer else 7.5 * inward),
        textcoords="offset points",
        ha="center",
        va="center",
        rotation=angle,
        rotation_mode="anchor",
        **style,
    )


def _is_closed(rows: npt.NDArray[Any]) -> bool:
    """Return whether the segments, in their order, form a closed outline, such as that of a piece of furniture."""
    return len(rows) > 2 and bool(np.allclose(rows[:, 2:], np.roll(rows[:, :2], -1, axis=0)))
