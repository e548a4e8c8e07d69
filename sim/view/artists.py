"""Draws with Matplotlib. Each function adds artists to an Axes, in the style of `sim.view.marks`, and returns them.

Units are metres, frame `map`. The static figures and the live view use the same functions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, PathPatch, Polygon
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from sim.lidar import LidarSpec
from sim.pose import Pose
from sim.robot import RobotSpec
from sim.view.marks import BEAMS, MARKS, MIDDLE, OWN, POINTER, spacing_of
from sim.view.shapes import (
    Floats,
    Moment,
    beam_ends,
    body_outline,
    is_full_turn,
    margin_of,
    nose_outline,
    outlines,
    place,
)
from sim.view.theme import Theme
from sim.world import World


def area(name: str, theme: Theme, robot_colour: str = "") -> dict[str, Any]:
    """Return the style of a patch. Marks of a robot need `robot_colour`."""
    mark = MARKS[name]
    return {
        "facecolor": _colour(mark.fill, theme, robot_colour),
        "edgecolor": _colour(mark.line, theme, robot_colour),
        "linewidth": mark.width,
        "linestyle": (0, mark.dash) if mark.dash else "-",
        "alpha": mark.alpha,
        "zorder": mark.layer,
    }


def line(name: str, theme: Theme, robot_colour: str = "") -> dict[str, Any]:
    """Return the style of a line. Marks of a robot need `robot_colour`."""
    mark = MARKS[name]
    return {
        "color": _colour(mark.line, theme, robot_colour),
        "linewidth": mark.width,
        "linestyle": (0, mark.dash) if mark.dash else "-",
        "alpha": mark.alpha,
        "zorder": mark.layer,
    }


def symbol(name: str, theme: Theme, robot_colour: str = "", marker: str = "o") -> dict[str, Any]:
    """Return the style of a symbol, which has the same size in every world. Marks of a robot need `robot_colour`."""
    mark = MARKS[name]
    return {
        "linestyle": "none",
        "marker": marker,
        "markersize": mark.size,
        "color": _colour(mark.fill or mark.line, theme, robot_colour),
        "markerfacecolor": _colour(mark.fill, theme, robot_colour),
        "markeredgecolor": _colour(mark.line, theme, robot_colour),
        "markeredgewidth": mark.width,
        "alpha": mark.alpha,
        "zorder": mark.layer,
    }


def _colour(name: str, theme: Theme, robot_colour: str) -> str:
    return robot_colour if name == OWN else str(getattr(theme, name)) if name else "none"


def set_stage(ax: Axes, world: World, theme: Theme) -> None:
    """Set the limits of the Axes to those of the world, and add a grid in metres and unobtrusive ticks."""
    left, low, right, high = world.bounds
    margin = margin_of(world)
    ax.set_xlim(left - margin, right + margin)
    ax.set_ylim(low - margin, high + margin)
    ax.set_aspect("equal")
    ax.set_facecolor(theme.outside)
    for spine in ax.spines.values():
        spine.set_visible(False)
    spacing = spacing_of(max(right - left, high - low))
    for axis, start, end in ((ax.xaxis, left, right), (ax.yaxis, low, high)):
        ticks = np.arange(math.ceil(start / spacing - 1e-9), math.floor(end / spacing + 1e-9) + 1) * spacing
        labels = [f"{tick:g}" for tick in ticks]
        if labels:
            labels[-1] += " m"
        axis.set_ticks(ticks, labels=labels)
    ax.tick_params(length=0, labelsize=MARKS["words"].size, labelcolor=theme.muted, pad=3)
    ax.grid(True, **line("grid", theme))
    ax.set_axisbelow(True)


def draw_walls(ax: Axes, world: World, theme: Theme) -> list[Artist]:
    """Draw segments and circles. Closed outlines that do not contain a robot are filled."""
    style = line("wall", theme)
    lines = LineCollection(list(world.segments.reshape(-1, 2, 2)), capstyle="round", **_collection_style(style))
    ax.add_collection(lines, autolim=False)
    artists: list[Artist] = [lines]
    room, solid = outlines(world)
    artists.append(ax.add_patch(Polygon(room, closed=True, **area("floor", theme))))
    if solid:
        shape = Path.make_compound_path(*(Path(loop, closed=True) for loop in solid))
        artists.append(ax.add_patch(PathPatch(shape, **area("solid", theme))))
    for x, y, radius in world.circles.tolist():
        artists.append(ax.add_patch(Circle((x, y), radius, **area("pillar", theme))))
    return artists


def _collection_style(style: dict[str, Any]) -> dict[str, Any]:
    """Convert the style of a line to the style of a collection of lines."""
    return {"colors": style.pop("color"), "linewidths": style.pop("linewidth"), **style}


def draw_places(ax: Axes, world: World, theme: Theme, *, radius: float = 0.105, starts: bool = True) -> list[Artist]:
    """Draw goals (rings), the paths of moving obstacles (dotted) and, if `starts`, start poses (dashed robots)."""
    artists: list[Artist] = []
    for goal in world.goals:
        for name, share in (("goal", 1.0), ("goal ring", 1.0), ("goal middle", MIDDLE)):
            artists.append(ax.add_patch(Circle((goal.x, goal.y), share * goal.radius, **area(name, theme))))
    for start in world.starts if starts else ():
        artists.append(ax.add_patch(Circle((start.x, start.y), radius, **area("start", theme))))
        direction = radius * np.array([math.cos(start.theta), math.sin(start.theta)])
        ends = np.array([start.x, start.y]) + np.array([direction, POINTER * direction])
        artists += ax.plot(*ends.T, **line("start nose", theme))
    for mover in world.movers:
        path = np.array([*mover.path, *(mover.path[:1] if mover.loop else ())])
        artists += ax.plot(*path.T, **line("route", theme))
    return artists


def mover_patch(x: float, y: float, radius: float, theme: Theme) -> Circle:
    """Return the patch of a moving obstacle: a translucent disc with a rim."""
    return Circle((x, y), radius, **area("mover", theme))


def draw_robot(ax: Axes, spec: RobotSpec, pose: Pose, theme: Theme, colour: str) -> list[Artist]:
    """Draw the footprint to scale, an arrowhead for the heading, and a halo that makes the robot easy to find."""
    halo = ax.plot(pose.x, pose.y, **symbol("halo", theme, colour))
    body = Polygon(place(body_outline(spec), pose), closed=True, **area("body", theme, colour))
    nose = Polygon(place(nose_outline(spec), pose), closed=True, **area("nose", theme))
    ax.add_patch(body)
    ax.add_patch(nose)
    return [*halo, body, nose]


def name_text(ax: Axes, name: str, theme: Theme) -> Any:
    """Return the text with the name of a robot. Its `xy` has to be set to `anchor_of_name`."""
    text = ax.annotate(name, (0, 0), (0, 4), textcoords="offset points", ha="center", va="bottom", **text_style(theme))
    text.set_clip_on(True)
    return text


def anchor_of_name(spec: RobotSpec, pose: Pose) -> tuple[float, float]:
    """Return the point below a robot's name: the top of the circle that the robot covers as it turns."""
    return pose.x, pose.y + float(np.hypot(*body_outline(spec).T).max())


def text_style(theme: Theme) -> dict[str, Any]:
    """Return the style of text on the floor. Its outline in the paper's colour makes it readable on any background."""
    mark = MARKS["words"]
    return {
        "fontsize": mark.size,
        "color": _colour(mark.fill, theme, ""),
        "zorder": mark.layer,
        "path_effects": [withStroke(linewidth=mark.width, foreground=_colour(mark.line, theme, ""))],
    }


def chosen_beams(has_hit: npt.NDArray[np.bool_]) -> npt.NDArray[np.int64]:
    """Return the indices of the beams to draw as lines: about `BEAMS` at equal angles, but none that hit nothing."""
    is_candidate = np.zeros(len(has_hit), dtype=bool)
    is_candidate[:: max(1, round(len(has_hit) / BEAMS))] = True
    return np.flatnonzero(is_candidate & has_hit)


def draw_scan(ax: Axes, ranges: npt.NDArray[Any], lidar: LidarSpec, pose: Pose, theme: Theme) -> list[Artist]:
    """Draw thin beams, the free area of the scan, and a point for each hit."""
    mount, ends, has_hit = beam_ends(ranges, lidar, pose)
    outline = ends if is_full_turn(lidar) else np.vstack([mount, ends])
    free_area = Polygon(outline, closed=True, **area("seen", theme))
    ax.add_patch(free_area)
    rays = LineCollection(
        [np.vstack([mount, end]) for end in ends[chosen_beams(has_hit)]], **_collection_style(line("ray", theme))
    )
    ax.add_collection(rays, autolim=False)
    (points,) = ax.plot(*ends[has_hit].T, **symbol("hit", theme))
    return [free_area, rays, points]


def draw_track(ax: Axes, points: Floats, values: Floats, colours: Any, limits: tuple[float, float]) -> LineCollection:
    """Draw a track (K, 2), coloured by `values` (K,) between `limits`."""
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    mark = MARKS["track"]
    track = LineCollection(list(pieces), cmap=colours, linewidths=mark.width, capstyle="round", zorder=mark.layer)
    track.set_array((values[:-1] + values[1:]) / 2.0)
    track.set_clim(*limits)
    ax.add_collection(track, autolim=False)
    return track


def draw_crosses(ax: Axes, places: Sequence[tuple[float, float]], theme: Theme) -> list[Artist]:
    """Mark collisions with crosses."""
    if not places:
        return []
    x, y = zip(*places, strict=True)
    return [
        *ax.plot(x, y, **symbol("collision halo", theme, marker="x")),
        *ax.plot(x, y, **symbol("collision", theme, marker="x")),
    ]


def draw_moment(ax: Axes, moment: Moment, world: World, theme: Theme) -> None:
    """Draw the line to the nearest obstacle at a moment. At a marked moment, also draw a ring and write the note."""
    near, mark_name = moment.near, "gap" if moment.marked else "closest"
    if math.isfinite(near.x) and math.isfinite(near.y):
        ax.plot((moment.x, near.x), (moment.y, near.y), **line(mark_name, theme))
        ax.plot(near.x, near.y, **symbol(f"{mark_name} end", theme))
    if not moment.marked:
        style = {"textcoords": "offset points", "ha": "left", "va": "center", **text_style(theme)}
        ax.annotate(moment.words, moment.spot, (7, 0), annotation_clip=True, **style)
        return
    ax.plot(moment.x, moment.y, **symbol("instant", theme))
    left, low, right, high = world.bounds
    side = -1.0 if moment.x > (left + right) / 2 else 1.0
    rise = -1.0 if moment.y > (low + high) / 2 else 1.0
    ax.annotate(
        moment.words,
        moment.spot,
        (side * 30, rise * 34),
        textcoords="offset points",
        ha="left" if side > 0 else "right",
        va="bottom" if rise > 0 else "top",
        fontsize=9.5,
        linespacing=1.45,
        color=theme.ink,
        zorder=MARKS["words"].layer,
        bbox={"boxstyle": "round,pad=0.45", "facecolor": theme.paper, "edgecolor": theme.alarm, "linewidth": 1.0},
        arrowprops={"arrowstyle": "-", "color": theme.alarm, "linewidth": 1.0, "shrinkA": 0, "shrinkB": 7},
    )
