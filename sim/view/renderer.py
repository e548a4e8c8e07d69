"""Draws frames for a GIF or a video by blitting: the world, and beside it the scan in the robot's frame.

The walls are drawn once, and their pixels are stored. Each frame restores them and draws only what moves.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from matplotlib.transforms import Bbox
from PIL import Image

from sim.lidar import LidarSpec, Scan
from sim.pose import Pose
from sim.simulation import Simulation
from sim.view import artists
from sim.view.artists import area, line, symbol
from sim.view.marks import MARKS, PIECES
from sim.view.session import Frame
from sim.view.shapes import Floats, beam_ends, body_outline, is_full_turn, margin_of, movers_at, nose_outline, place
from sim.view.theme import STYLE, Theme
from sim.world import World

WIDTH, HEIGHT = 5.8, 4.6
"""The maximum size of the world in inches."""

SCAN_SIZE = 3.2
"""The size in inches of the scan in the robot's frame, beside the world."""

_LEFT, _BETWEEN, _RIGHT, _BOTTOM, _TOP = 0.44, 0.25, 0.11, 0.34, 0.38
"""The margins around the world and the scan, and between them, in inches."""


class Renderer:
    """Draws frames of one simulation."""

    def __init__(self, simulation: Simulation, theme: Theme, dpi: int = 100) -> None:
        self._simulation = simulation
        self._theme = theme
        self._lidar = simulation.robots[0].lidar
        with matplotlib.rc_context(STYLE):  # type: ignore[arg-type]
            sheet, boxes = _sheet(simulation.world)
            figure = Figure(figsize=sheet, dpi=dpi, facecolor=theme.paper)
            self._canvas: Any = FigureCanvasAgg(figure)
            self._world, self._scan_axes = (figure.add_axes(box) for box in boxes)
            artists.set_stage(self._world, simulation.world, theme)
            artists.draw_walls(self._world, simulation.world, theme)
            artists.draw_places(self._world, simulation.world, theme, radius=simulation.robots[0].radius)
            self._local_robot = _prepare_scan_axes(self._scan_axes, simulation, theme)
            self._moving_artists = self._add_moving_artists()
            self._texts: tuple[str, str, bool] | None = None
            self._text_box = Bbox.from_extents(0, math.ceil(self._world.bbox.y1), figure.bbox.width, figure.bbox.height)
            for artist in (*self._moving_artists, self._time_text, self._speed_text):
                artist.set_animated(True)
            canvas: Any = self._canvas
            canvas.draw()
            self._background = canvas.copy_from_bbox(figure.bbox)

    def draw(self, frame: Frame, trail: Floats | None = None) -> Image.Image:
        """Return the frame as an RGB image. `trail` is the first robot's track, (K, 2) in metres."""
        self._canvas.restore_region(self._background)
        self._update(frame, trail)
        for artist in self._moving_artists:
            if artist.get_visible() and artist.axes is not None:
                artist.axes.draw_artist(artist)
        self._write(frame)
        width, height = self._canvas.get_width_height()
        return Image.frombuffer("RGBA", (width, height), self._canvas.buffer_rgba(), "raw", "RGBA", 0, 1).convert("RGB")

    def _write(self, frame: Frame) -> None:
        """Write the time and the speed above the axes. Text is slow to draw, so its pixels are reused."""
        first = frame.state.robots[0]
        speed = f"{first.velocity.linear:+.2f} m/s   {first.velocity.angular:+.2f} rad/s"
        texts = (f"{frame.state.time_ns / 1e9:.1f} s", speed, first.collided)
        if texts != self._texts:
            self._time_text.set_text(texts[0])
            self._speed_text.set_text(speed + ("  ·  blocked" if first.collided else ""))
            self._speed_text.set_color(self._theme.alarm if first.collided else self._theme.muted)
            self._world.draw_artist(self._time_text)
            self._scan_axes.draw_artist(self._speed_text)
            self._texts, self._text_pixels = texts, self._canvas.copy_from_bbox(self._text_box)
        else:
            self._canvas.restore_region(self._text_pixels)

    def _add_moving_artists(self) -> list[Artist]:
        theme, world, scan_axes = self._theme, self._world, self._scan_axes
        simulation = self._simulation
        self._free_area: Any = world.add_patch(Polygon(np.zeros((3, 2)), closed=True, **area("seen", theme)))
        (self._rays,) = world.plot([], [], **line("ray", theme))
        (self._hits,) = world.plot([], [], **symbol("hit", theme))
        mark = MARKS["track"]
        colours = theme.time_colours(0)
        self._trail = LineCollection([], cmap=colours, linewidths=mark.width, capstyle="round", zorder=mark.layer)
        self._trail.set_clim(0.0, 1.0)
        world.add_collection(self._trail, autolim=False)
        self._movers: list[Any] = [
            world.add_patch(artists.mover_patch(0.0, 0.0, mover.radius, theme)) for mover in simulation.world.movers
        ]
        self._halos: list[Any] = []
        self._bodies: list[tuple[Any, Any]] = []
        self._names: list[Any] = []
        for index, spec in enumerate(simulation.robots):
            colour = theme.robot_colour(index)
            self._halos += world.plot([], [], **symbol("halo", theme, colour))
            body = world.add_patch(Polygon(np.zeros((3, 2)), **area("body", theme, colour)))
            nose = world.add_patch(Polygon(np.zeros((3, 2)), **area("nose", theme)))
            self._bodies.append((body, nose))
            if len(simulation.robots) > 1:
                self._names.append(artists.name_text(world, spec.name, theme))
        self._local_free_area: Any = scan_axes.add_patch(Polygon(np.zeros((3, 2)), closed=True, **area("seen", theme)))
        (self._local_rays,) = scan_axes.plot([], [], **line("ray", theme))
        (self._local_hits,) = scan_axes.plot([], [], **symbol("hit", theme))
        style: dict[str, Any] = {
            "textcoords": "offset points",
            "xycoords": "axes fraction",
            "annotation_clip": False,
            "fontsize": 9.5,
        }
        self._time_text = world.annotate("", (0, 1), (0, 6), color=theme.ink, **style)
        self._speed_text = scan_axes.annotate("", (0, 1), (0, 6), color=theme.muted, **style)
        bodies = [part for pair in self._bodies for part in pair]
        return [
            *(self._free_area, self._rays, self._trail, *self._movers, self._hits, *self._halos, *bodies, *self._names),
            *(self._local_free_area, self._local_rays, *self._local_robot, self._local_hits),
        ]

    def _update(self, frame: Frame, trail: Floats | None) -> None:
        state = frame.state
        for index, (robot, spec) in enumerate(zip(state.robots, self._simulation.robots, strict=True)):
            body, nose = self._bodies[index]
            body.set_xy(place(body_outline(spec), robot.pose))
            nose.set_xy(place(nose_outline(spec), robot.pose))
            body.set_facecolor(self._theme.alarm if robot.collided else self._theme.robot_colour(index))
            self._halos[index].set_data([robot.pose.x], [robot.pose.y])
        for text, robot, spec in zip(self._names, state.robots, self._simulation.robots, strict=False):
            text.xy = artists.anchor_of_name(spec, robot.pose)  # `_names` is empty for a single robot
        for patch, centre in zip(self._movers, movers_at(self._simulation, state.time_ns), strict=True):
            patch.center = centre
        pieces = _pieces(np.empty((0, 2)) if trail is None else trail)
        self._trail.set_segments(pieces)
        self._trail.set_array((np.arange(len(pieces)) + 0.5) / max(1, len(pieces)))
        self._update_scan(frame.scans[0])

    def _update_scan(self, newest: tuple[Scan, Pose] | None) -> None:
        parts = (self._free_area, self._rays, self._hits, self._local_free_area, self._local_rays, self._local_hits)
        is_visible = newest is not None and self._lidar is not None
        for part in parts:
            part.set_visible(is_visible)
        if newest is None or self._lidar is None:
            return
        scan, pose = newest
        _set_scan(scan, self._lidar, pose, self._free_area, self._rays, self._hits)
        upward = Pose(0.0, 0.0, math.pi / 2)  # x of base_link points up on the paper
        _set_scan(scan, self._lidar, upward, self._local_free_area, self._local_rays, self._local_hits)


def _sheet(world: World) -> tuple[tuple[float, float], list[tuple[float, float, float, float]]]:
    """Return the size of a frame in inches, and the boxes of the world and the scan as shares of it."""
    left, low, right, high = world.bounds
    across, up = (side + 2 * margin_of(world) for side in (max(right - left, 0.1), max(high - low, 0.1)))
    scale = min(WIDTH / across, HEIGHT / up)
    width, height = max(across * scale, 1.5), max(up * scale, 0.5)
    sheet = (_LEFT + width + _BETWEEN + SCAN_SIZE + _RIGHT, max(_BOTTOM + height, SCAN_SIZE) + _TOP)
    top = sheet[1] - _TOP
    boxes = ((_LEFT, top - height, width, height), (_LEFT + width + _BETWEEN, top - SCAN_SIZE, SCAN_SIZE, SCAN_SIZE))
    return sheet, [(x / sheet[0], y / sheet[1], w / sheet[0], h / sheet[1]) for x, y, w, h in boxes]


def _pieces(track: Floats) -> list[Floats]:
    """Divide a track (K, 2) into at most `PIECES` pieces, each of which begins at the end of the previous one."""
    cuts = np.unique(np.linspace(0, max(0, len(track) - 1), PIECES + 1).round().astype(int)).tolist()
    return [track[start : end + 1] for start, end in pairwise(cuts)]


def _set_scan(scan: Scan, lidar: LidarSpec, pose: Pose, free_area: Polygon, rays: Any, hits: Any) -> None:
    mount, ends, has_hit = beam_ends(scan.ranges, lidar, pose)
    free_area.set_xy(ends if is_full_turn(lidar) else np.vstack([mount, ends]))
    beam_indices = artists.chosen_beams(has_hit)
    lines = np.full((3 * len(beam_indices), 2), np.nan)
    lines[0::3], lines[1::3] = mount, ends[beam_indices]
    rays.set_data(*lines.T)
    hits.set_data(*ends[has_hit].T)


def _prepare_scan_axes(ax: Axes, simulation: Simulation, theme: Theme) -> list[Artist]:
    """Draw the rings and bearings around the robot, with x of base_link upwards; return the artists of the robot."""
    spec, world = simulation.robots[0], simulation.world
    size = max(world.bounds[2] - world.bounds[0], world.bounds[3] - world.bounds[1])
    reach = min(spec.lidar.range_max if spec.lidar is not None else 3.0, 0.5 * size)
    ax.set_xlim(-1.15 * reach, 1.15 * reach)
    ax.set_ylim(-1.15 * reach, 1.15 * reach)
    ax.set_aspect("equal", anchor="N")
    ax.set_axis_off()
    spacing = next(step for step in (0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, math.inf) if reach / step <= 4)
    for ring in np.arange(spacing, reach + 1e-9, spacing) if math.isfinite(spacing) else ():
        ax.add_patch(Circle((0, 0), ring, fill=False, edgecolor=theme.grid, linewidth=0.9, zorder=0.5))
        corner = ring * math.sqrt(0.5)
        ax.text(corner, -corner, f"{ring:g} m", fontsize=7, color=theme.muted, ha="center", va="center", zorder=7)
    for bearing, text in ((0, "0° x"), (90, "90° y"), (180, "180°"), (-90, "−90°")):  # noqa: RUF001
        x, y = -math.sin(math.radians(bearing)), math.cos(math.radians(bearing))
        ax.plot([0, x * reach], [0, y * reach], color=theme.grid, linewidth=0.9, zorder=0.5)
        ax.text(1.07 * x * reach, 1.07 * y * reach, text, fontsize=7.5, color=theme.muted, ha="center", va="center")
    upward = Pose(0.0, 0.0, math.pi / 2)
    halo, *robot = artists.draw_robot(ax, spec, upward, theme, theme.robot)
    halo.remove()  # it would hide nearby obstacles
    return robot
