"""Frames for the live view: the world, and beside it the scan as the robot sees it, drawn by blitting.

The walls are drawn once and kept as pixels. A frame puts them back, draws only what moves, and encodes the canvas. On
the machine this was written on a frame takes some milliseconds, most of it the encoding.
"""

from __future__ import annotations

import io
import math
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from matplotlib.transforms import Bbox
from PIL import Image

from sim.lidar import LidarSpec, Scan
from sim.pose import Pose
from sim.simulation import Simulation
from sim.view import artists
from sim.view.session import Frame
from sim.view.stage import write_names
from sim.view.theme import STYLE, Theme

Floats = npt.NDArray[np.float64]

WIDTH, HEIGHT = 9.8, 4.5
"""Inches of a frame."""

BEAMS = 120
"""At most so many beams are drawn as lines; every hit is drawn as a point."""


class Renderer:
    """Draws frames of one simulation."""

    def __init__(self, simulation: Simulation, theme: Theme, dpi: int = 100, *, names: bool = False) -> None:
        self._simulation = simulation
        self._theme = theme
        self._lidar = simulation.robots[0].lidar
        with matplotlib.rc_context(STYLE):  # type: ignore[arg-type]
            figure = Figure(figsize=(WIDTH, HEIGHT), dpi=dpi, facecolor=theme.paper)
            self._canvas: Any = FigureCanvasAgg(figure)
            self._world = figure.add_axes((0.045, 0.075, 0.595, 0.84))
            self._sight = figure.add_axes((0.665, 0.075, 0.325, 0.84))
            artists.set_stage(self._world, simulation.world, theme)
            self._world.set_anchor("NW")
            artists.draw_walls(self._world, simulation.world, theme)
            artists.draw_places(self._world, simulation.world, theme, radius=simulation.robots[0].radius)
            if names:
                write_names(self._world, simulation.world, theme)
            self._centre = _sight_stage(self._sight, simulation, theme)
            self._moving = self._add_moving()
            self._said: tuple[str, str, bool] | None = None
            self._above = Bbox.from_extents(0, math.ceil(self._world.bbox.y1), figure.bbox.width, figure.bbox.height)
            for artist in (*self._moving, self._clock, self._words):
                artist.set_animated(True)
            canvas: Any = self._canvas
            canvas.draw()
            self._background = canvas.copy_from_bbox(figure.bbox)

    def draw(self, frame: Frame, trail: Floats | None = None) -> Image.Image:
        """Return the frame as an RGB image; `trail` is the first robot's track so far, (K, 2) in metres."""
        return self._drawn(frame, trail, "RGBA").convert("RGB")

    def jpeg(self, frame: Frame, trail: Floats | None = None, quality: int = 84) -> bytes:
        """Return the frame as JPEG, colours at full resolution so that thin lines stay clean."""
        stream = io.BytesIO()
        self._drawn(frame, trail, "RGBX").save(stream, "JPEG", quality=quality, subsampling=0)
        return stream.getvalue()

    def png(self, frame: Frame, trail: Floats | None = None) -> bytes:
        """Return the frame as PNG."""
        stream = io.BytesIO()
        self.draw(frame, trail).save(stream, "PNG", compress_level=1)
        return stream.getvalue()

    def _drawn(self, frame: Frame, trail: Floats | None, mode: str) -> Image.Image:
        self._canvas.restore_region(self._background)
        self._update(frame, trail)
        for artist in self._moving:
            if artist.get_visible() and artist.axes is not None:
                artist.axes.draw_artist(artist)
        self._write(frame)
        width, height = self._canvas.get_width_height()
        return Image.frombuffer(mode, (width, height), self._canvas.buffer_rgba(), "raw", mode, 0, 1)

    def _write(self, frame: Frame) -> None:
        """Write the time and the speed above the axes; letters are slow, so that they are kept until they change."""
        first = frame.state.robots[0]
        speed = f"{first.velocity.linear:+.2f} m/s   {first.velocity.angular:+.2f} rad/s"
        said = (f"{frame.state.time_ns / 1e9:.1f} s", speed, first.collided)
        if said != self._said:
            self._clock.set_text(said[0])
            self._words.set_text(speed + ("  ·  blocked" if first.collided else ""))
            self._words.set_color(self._theme.alarm if first.collided else self._theme.muted)
            self._world.draw_artist(self._clock)
            self._sight.draw_artist(self._words)
            self._said, self._line = said, self._canvas.copy_from_bbox(self._above)
        else:
            self._canvas.restore_region(self._line)

    def _add_moving(self) -> list[Artist]:
        theme, world, sight = self._theme, self._world, self._sight
        self._seen: Any = world.add_patch(_area(theme))
        (self._rays,) = world.plot([], [], color=theme.beam, linewidth=0.5, alpha=0.45, zorder=3)
        (self._hits,) = world.plot([], [], "o", markersize=2.2, color=theme.hit, mew=0, zorder=6)
        (self._trail,) = world.plot([], [], color=theme.robot, linewidth=2.0, alpha=0.55, zorder=5)
        self._movers: list[Any] = [
            world.add_patch(artists.mover_patch(0.0, 0.0, mover.radius, theme))
            for mover in self._simulation.world.movers
        ]
        self._halos: list[Any] = []
        self._bodies: list[tuple[Any, Any]] = []
        for index in range(len(self._simulation.robots)):
            colour = theme.robot_colour(index)
            self._halos += world.plot([], [], "o", markersize=24, color=colour, alpha=0.16, mew=0, zorder=7.5)
            body = world.add_patch(Polygon(np.zeros((3, 2)), facecolor=colour, edgecolor=theme.paper, linewidth=1.0))
            nose = world.add_patch(Polygon(np.zeros((3, 2)), facecolor=theme.paper, linewidth=0))
            self._bodies.append((body, nose))
        self._near_seen: Any = sight.add_patch(_area(theme))
        (self._near_rays,) = sight.plot([], [], color=theme.beam, linewidth=0.5, alpha=0.35, zorder=3)
        (self._near_hits,) = sight.plot([], [], "o", markersize=2.6, color=theme.hit, mew=0, zorder=6)
        style: dict[str, Any] = {
            "textcoords": "offset points",
            "xycoords": "axes fraction",
            "annotation_clip": False,
            "fontsize": 9.5,
        }
        self._clock = world.annotate("", (0, 1), (0, 6), color=theme.ink, **style)
        self._words = sight.annotate("", (0, 1), (0, 6), color=theme.muted, **style)
        pairs = [part for pair in self._bodies for part in pair]
        return [
            *(self._seen, self._rays, self._trail, *self._movers, self._hits, *self._halos, *pairs),
            *(self._near_seen, self._near_rays, *self._centre, self._near_hits),
        ]

    def _update(self, frame: Frame, trail: Floats | None) -> None:
        state = frame.state
        for index, (robot, spec) in enumerate(zip(state.robots, self._simulation.robots, strict=True)):
            body, nose = self._bodies[index]
            body.set_xy(artists.place(artists.body_outline(spec), robot.pose))
            nose.set_xy(artists.place(artists.nose_outline(spec), robot.pose))
            body.set_facecolor(self._theme.alarm if robot.collided else self._theme.robot_colour(index))
            self._halos[index].set_data([robot.pose.x], [robot.pose.y])
        for patch, place in zip(self._movers, artists.movers_at(self._simulation, state.time_ns), strict=True):
            patch.center = place
        points = np.empty((0, 2)) if trail is None else trail
        self._trail.set_data(*points.T)
        self._update_scan(frame.scans[0])

    def _update_scan(self, newest: tuple[Scan, Pose] | None) -> None:
        parts = (self._seen, self._rays, self._hits, self._near_seen, self._near_rays, self._near_hits)
        shown = newest is not None and self._lidar is not None
        for part in parts:
            part.set_visible(shown)
        if newest is None or self._lidar is None:
            return
        scan, pose = newest
        _set_scan(scan, self._lidar, pose, self._seen, self._rays, self._hits)
        upward = Pose(0.0, 0.0, math.pi / 2)  # x of base_link points up on the paper
        _set_scan(scan, self._lidar, upward, self._near_seen, self._near_rays, self._near_hits)


def _set_scan(scan: Scan, lidar: LidarSpec, pose: Pose, seen: Polygon, rays: Any, hits: Any) -> None:
    mount, ends, hit = artists.beam_ends(scan.ranges, lidar, pose)
    seen.set_xy(ends if artists.is_full_turn(lidar) else np.vstack([mount, ends]))
    chosen = np.flatnonzero(hit)[:: max(1, math.ceil(len(ends) / BEAMS))]
    lines = np.full((3 * len(chosen), 2), np.nan)
    lines[0::3], lines[1::3] = mount, ends[chosen]
    rays.set_data(*lines.T)
    hits.set_data(*ends[hit].T)


def _area(theme: Theme) -> Polygon:
    return Polygon(np.zeros((3, 2)), closed=True, facecolor=theme.beam, alpha=0.10, linewidth=0, zorder=1.5)


def _sight_stage(ax: Axes, simulation: Simulation, theme: Theme) -> list[Artist]:
    """Draw the rings and bearings of the view in base_link, x upwards; return the robot in the middle."""
    spec, world = simulation.robots[0], simulation.world
    size = max(world.bounds[2] - world.bounds[0], world.bounds[3] - world.bounds[1])
    reach = min(spec.lidar.range_max if spec.lidar is not None else 3.0, 0.5 * size)
    ax.set_xlim(-1.2 * reach, 1.2 * reach)
    ax.set_ylim(-1.2 * reach, 1.2 * reach)
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
    halo.remove()  # it would hide what is near
    return robot
