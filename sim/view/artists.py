"""What a world, a robot, a scan and a track look like: each function adds artists to an Axes and returns them.

Units are metres, frame `map`. Sizes on the paper are in points and chosen for a projector. The static figures and the
live view are drawn by the same functions.
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

from sim.lidar import LidarSpec
from sim.pose import Pose
from sim.robot import RobotSpec
from sim.simulation import Simulation
from sim.view.theme import Theme
from sim.world import World

Floats = npt.NDArray[np.float64]

MARGIN = 0.035
"""Paper around the world's bounds, as a share of its larger side: room for the names of the outer walls."""


def set_stage(ax: Axes, world: World, theme: Theme) -> None:
    """Give `ax` the world's limits, a metre grid and quiet ticks."""
    left, low, right, high = world.bounds
    margin = margin_of(world)
    ax.set_xlim(left - margin, right + margin)
    ax.set_ylim(low - margin, high + margin)
    ax.set_aspect("equal")
    ax.set_facecolor(theme.outside)
    for spine in ax.spines.values():
        spine.set_visible(False)
    spacing = _grid_spacing(max(right - left, high - low))
    for axis, start, end in ((ax.xaxis, left, right), (ax.yaxis, low, high)):
        ticks = np.arange(math.ceil(start / spacing - 1e-9), math.floor(end / spacing + 1e-9) + 1) * spacing
        labels = [f"{tick:g}" for tick in ticks]
        if labels:
            labels[-1] += " m"
        axis.set_ticks(ticks, labels=labels)
    ax.tick_params(length=0, labelsize=8.5, labelcolor=theme.muted, pad=3)
    ax.grid(True, color=theme.grid, linewidth=0.7, zorder=0.5)
    ax.set_axisbelow(True)


def margin_of(world: World) -> float:
    """Return the paper around the world's bounds, in metres."""
    left, low, right, high = world.bounds
    return max(0.05, MARGIN * max(right - left, high - low))


def _grid_spacing(extent: float) -> float:
    steps = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
    return next((step for step in steps if extent / step <= (14 if step >= 1.0 else 8)), steps[-1])


def draw_walls(ax: Axes, world: World, theme: Theme) -> list[Artist]:
    """Draw segments and circles; what is closed all round, and holds no robot, is filled."""
    lines = LineCollection(
        list(world.segments.reshape(-1, 2, 2)), colors=theme.wall, linewidths=2.2, capstyle="round", zorder=4
    )
    ax.add_collection(lines, autolim=False)
    artists: list[Artist] = [lines]
    room, solid = outlines(world)
    artists.append(ax.add_patch(Polygon(room, closed=True, facecolor=theme.floor, linewidth=0, zorder=0.3)))
    if solid:
        shape = Path.make_compound_path(*(Path(loop, closed=True) for loop in solid))
        artists.append(ax.add_patch(PathPatch(shape, facecolor=theme.solid, linewidth=0, zorder=1.2)))
    for x, y, radius in world.circles.tolist():
        artists.append(
            ax.add_patch(Circle((x, y), radius, facecolor=theme.solid, edgecolor=theme.wall, linewidth=1.8, zorder=4))
        )
    return artists


def outlines(world: World) -> tuple[Floats, list[Floats]]:
    """Return the outline of the room the robot starts in, and those of solid things, each (K, 2).

    An outline is a run of segments each of which starts where the last one ended, and which closes. The room is the
    smallest around the start pose (the world's bounds, if none is). It is no solid thing, unless an odd number of
    others are around it: then it is the inner face of a thick wall.
    """
    loops = _closed_loops(world.segments)
    here = (world.starts[0].x, world.starts[0].y)
    around = sorted(
        (index for index, loop in enumerate(loops) if Path(loop).contains_point(here)),
        key=lambda index: float(np.ptp(loops[index], axis=0).prod()),
    )
    if not around:
        left, low, right, high = world.bounds
        return np.array([[left, low], [right, low], [right, high], [left, high]]), loops
    room = loops[around[0]]
    if len(around) % 2:
        del loops[around[0]]
    return room, loops


def _closed_loops(segments: Floats) -> list[Floats]:
    loops: list[Floats] = []
    first = 0
    for index in range(len(segments)):
        if index > first and not np.array_equal(segments[index, :2], segments[index - 1, 2:]):
            first = index
        if index > first + 1 and np.array_equal(segments[index, 2:], segments[first, :2]):
            loops.append(np.vstack([segments[first : index + 1, :2], segments[first, :2]]))
            first = index + 1
    return loops


def draw_places(ax: Axes, world: World, theme: Theme, *, radius: float = 0.105, starts: bool = True) -> list[Artist]:
    """Draw goals (rings), the paths of moving obstacles (dotted) and, if wanted, start poses (dashed robots)."""
    artists: list[Artist] = []
    for goal in world.goals:
        artists += [
            ax.add_patch(
                Circle((goal.x, goal.y), goal.radius, facecolor=theme.goal, alpha=0.12, edgecolor="none", zorder=1)
            ),
            ax.add_patch(
                Circle((goal.x, goal.y), goal.radius, fill=False, edgecolor=theme.goal, linewidth=1.4, zorder=2)
            ),
            ax.add_patch(Circle((goal.x, goal.y), goal.radius * 0.18, color=theme.goal, linewidth=0, zorder=2)),
        ]
    for start in world.starts if starts else ():
        artists.append(
            ax.add_patch(
                Circle(
                    (start.x, start.y),
                    radius,
                    fill=False,
                    edgecolor=theme.start,
                    linewidth=1.1,
                    linestyle=(0, (2.2, 1.8)),
                    zorder=2,
                )
            )
        )
        tip = (start.x + 2.6 * radius * math.cos(start.theta), start.y + 2.6 * radius * math.sin(start.theta))
        nose = (start.x + radius * math.cos(start.theta), start.y + radius * math.sin(start.theta))
        artists += ax.plot(*zip(nose, tip, strict=True), color=theme.start, linewidth=1.1, zorder=2)
    for mover in world.movers:
        path = np.array([*mover.path, *(mover.path[:1] if mover.loop else ())])
        artists += ax.plot(*path.T, color=theme.mover, linewidth=1.0, linestyle=(0, (1, 2.4)), zorder=1)
    return artists


def mover_patch(x: float, y: float, radius: float, theme: Theme) -> Circle:
    """Return a moving obstacle: a soft disc with a double rim."""
    return Circle((x, y), radius, facecolor=theme.mover, alpha=0.85, edgecolor=theme.paper, linewidth=1.0, zorder=5)


def body_outline(spec: RobotSpec, points: int = 40) -> Floats:
    """Return the footprint of `spec` as (N, 2) points in base_link."""
    if spec.footprint is not None:
        return np.array(spec.footprint, dtype=np.float64)
    angle = np.linspace(0.0, math.tau, points, endpoint=False)
    return spec.radius * np.column_stack([np.cos(angle), np.sin(angle)])


def nose_outline(spec: RobotSpec) -> Floats:
    """Return the arrowhead on the robot's back that shows where it looks, as (4, 2) points in base_link."""
    reach = float(np.hypot(*body_outline(spec).T).max())
    return reach * np.array([[0.78, 0.0], [-0.45, 0.48], [-0.2, 0.0], [-0.45, -0.48]])


def place(outline: Floats, pose: Pose) -> Floats:
    """Return `outline`, (N, 2) in base_link, in the frame `map`."""
    cosine, sine = math.cos(pose.theta), math.sin(pose.theta)
    x, y = outline.T
    return np.column_stack([pose.x + cosine * x - sine * y, pose.y + sine * x + cosine * y])


def draw_robot(ax: Axes, spec: RobotSpec, pose: Pose, theme: Theme, colour: str) -> list[Artist]:
    """Draw the footprint to scale, an arrowhead for the heading, and a halo that is found from the back row."""
    halo = ax.plot(pose.x, pose.y, "o", markersize=24, color=colour, alpha=0.16, mew=0, zorder=7.5)
    body = Polygon(
        place(body_outline(spec), pose), closed=True, facecolor=colour, edgecolor=theme.paper, linewidth=1.2, zorder=8
    )
    nose = Polygon(place(nose_outline(spec), pose), closed=True, facecolor=theme.paper, linewidth=0, zorder=9)
    ax.add_patch(body)
    ax.add_patch(nose)
    return [*halo, body, nose]


def beam_ends(ranges: npt.NDArray[Any], lidar: LidarSpec, pose: Pose) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
    """Return the sensor's place (2,), each beam's end (N, 2) in metres, and which beams hit something (N,).

    A beam without a return ends at `range_max`; one that is invalid or too close ends at the sensor.
    """
    mount = place(np.array([[lidar.mount.x, lidar.mount.y]]), pose)[0]
    angles = pose.theta + lidar.mount.theta + lidar.angle_min + np.arange(lidar.beams) * lidar.angle_increment
    ranges = np.asarray(ranges, dtype=np.float64)
    hit = np.isfinite(ranges)
    length = np.where(hit, ranges, np.where(ranges == math.inf, lidar.range_max, 0.0))
    ends = mount + length[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return mount, ends, hit


def is_full_turn(lidar: LidarSpec) -> bool:
    """Say whether the beams go all the way round."""
    return math.isclose(lidar.beams * lidar.angle_increment, math.tau, rel_tol=0.02)


def draw_scan(
    ax: Axes, ranges: npt.NDArray[Any], lidar: LidarSpec, pose: Pose, theme: Theme, *, beams: int = 90
) -> list[Artist]:
    """Draw about `beams` thin beams, the area that the scan has seen to be free, and a point for each hit."""
    mount, ends, hit = beam_ends(ranges, lidar, pose)
    outline = ends if is_full_turn(lidar) else np.vstack([mount, ends])
    seen = Polygon(outline, closed=True, facecolor=theme.beam, alpha=0.10, linewidth=0, zorder=1.5)
    ax.add_patch(seen)
    shown = np.zeros(len(ends), dtype=bool)
    shown[:: max(1, round(len(ends) / beams))] = True
    rays = LineCollection(
        [np.vstack([mount, end]) for end in ends[shown & hit]],
        colors=theme.beam,
        linewidths=0.5,
        alpha=0.45,
        zorder=3,
    )
    ax.add_collection(rays, autolim=False)
    (points,) = ax.plot(*ends[hit].T, linestyle="none", marker="o", markersize=2.4, color=theme.hit, mew=0, zorder=6)
    return [seen, rays, points]


def draw_track(ax: Axes, points: Floats, values: Floats, colours: Any, limits: tuple[float, float]) -> LineCollection:
    """Draw a track (K, 2) whose pieces are coloured by `values` (K,) between `limits`."""
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    track = LineCollection(list(pieces), cmap=colours, linewidths=2.6, capstyle="round", zorder=5)
    track.set_array((values[:-1] + values[1:]) / 2.0)
    track.set_clim(*limits)
    ax.add_collection(track, autolim=False)
    return track


def draw_crosses(ax: Axes, places: Sequence[tuple[float, float]], theme: Theme) -> list[Artist]:
    """Mark collisions."""
    if not places:
        return []
    x, y = zip(*places, strict=True)
    halo = ax.plot(x, y, linestyle="none", marker="x", markersize=7.5, mew=3.6, color=theme.paper, zorder=10)
    cross = ax.plot(x, y, linestyle="none", marker="x", markersize=6.5, mew=1.8, color=theme.alarm, zorder=11)
    return [*halo, *cross]


def movers_at(simulation: Simulation, time_ns: int) -> list[tuple[float, float]]:
    """Return where the centre of each moving obstacle is at `time_ns`, in metres."""
    return [(x, y) for x, y, _ in simulation.scene.movers_at(time_ns)]
