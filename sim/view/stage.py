"""Prepares the Axes of a picture: its size, title, names and legend."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sim.view.artists import set_stage
from sim.view.marks import MARKS
from sim.view.names import names_of
from sim.view.shapes import margin_of
from sim.view.theme import Theme
from sim.world import World

WIDTH = 7.6
HEIGHT = 5.4
"""The maximum size of a picture in inches."""

_LEFT, _RIGHT, _BOTTOM, _TOP = 0.42, 0.16, 0.34, 0.60
"""The margins around the axes in inches."""


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
    """Write the names of walls, furniture, pillars and goals."""
    for name in names_of(world):
        ax.annotate(
            name.text,
            (name.x, name.y),
            (name.right, name.up),
            textcoords="offset points",
            ha="center",
            va="center",
            rotation=math.degrees(name.angle),
            rotation_mode="anchor",
            fontsize=MARKS["name"].size,
            color=getattr(theme, name.colour),
            zorder=MARKS["name"].layer,
            annotation_clip=False,
        )
