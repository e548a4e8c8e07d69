"""Computes the shapes in pictures: outlines of rooms, robots and scans, and the nearest approach of a run.

Lengths are metres. Coordinates are in the frame `map` unless a function says otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.path import Path

from sim.clearance import Clearance
from sim.lidar import LidarSpec
from sim.pose import Pose
from sim.recording import Recording
from sim.robot import RobotSpec
from sim.rows import row_at, state_at
from sim.simulation import Simulation, clearance
from sim.world import World

Floats = npt.NDArray[np.float64]

MARGIN = 0.035
"""The margin around the world, in which the names of outer walls are written, as a share of its larger side."""


@dataclass(frozen=True)
class Moment:
    """A moment of a run that a picture marks.

    Attributes:
        time: the time in seconds.
        x, y: the position of the robot's centre.
        near: the obstacle nearest to the robot.
        words: the text beside the mark.
        marked: whether the user has chosen the moment. Otherwise, it is the one with the smallest clearance.
    """

    time: float
    x: float
    y: float
    near: Clearance
    words: str
    marked: bool

    @property
    def spot(self) -> tuple[float, float]:
        """The place for the text: the robot at a chosen moment, otherwise the middle of the gap to the obstacle."""
        gap, centre_distance = max(0.0, self.near.distance), math.hypot(self.x - self.near.x, self.y - self.near.y)
        if self.marked or centre_distance == 0.0:
            return self.x, self.y
        share = min(1.0, gap / centre_distance) / 2
        return self.near.x + share * (self.x - self.near.x), self.near.y + share * (self.y - self.near.y)


def moment_of(recording: Recording, indices: list[int], mark: float | None, note: str) -> Moment | None:
    """Return the moment to mark: the chosen one, or the one with the smallest clearance.

    With several robots, or after a collision, which has its own symbol, only a chosen moment is marked.

    Args:
        recording: the run.
        indices: the indices of the robots that are drawn. The moment belongs to the run of the first one.
        mark: the time of the chosen moment, in seconds.
        note: the text for the chosen moment.

    Raises:
        ValueError: `mark` is not finite.
    """
    index = indices[0]
    spec = recording.simulation.robots[index]
    if mark is not None:
        row = row_at(recording, mark)
        words = f"t = {recording.times[row]:.1f} s" + (f"\n{note}" if note else "")
    else:
        distances = recording.clearances[:, index]
        has_collided = any(event.kind == "collision" and event.robot == spec.name for event in recording.events)
        if len(indices) > 1 or has_collided or not np.isfinite(distances).any():
            return None
        row = int(np.nanargmin(distances))
        words = f"{max(0.0, float(distances[row])):.2f} m"
    x, y, _ = recording.poses[row, index].tolist()
    near = clearance(recording.simulation, state_at(recording, row), spec.name)
    return Moment(float(recording.times[row]), x, y, near, words, mark is not None)


def margin_of(world: World) -> float:
    """Return the margin around the world's bounds, in metres."""
    left, low, right, high = world.bounds
    return max(0.05, MARGIN * max(right - left, high - low))


def outlines(world: World) -> tuple[Floats, list[Floats]]:
    """Return the outline of the room in which the robot starts, and those of solid objects, each (K, 2).

    An outline is a closed sequence of segments, each of which starts at the end of the previous one. The room is the
    smallest one around the start pose, or the world's bounds if none surrounds it. It is not a solid object, unless an
    odd number of others surround it: then it is the inner face of a thick wall.
    """
    loops = _closed_loops(world.segments)
    start = (world.starts[0].x, world.starts[0].y)
    surrounding_indices = sorted(
        (index for index, loop in enumerate(loops) if Path(loop).contains_point(start)),
        key=lambda index: float(np.ptp(loops[index], axis=0).prod()),
    )
    if not surrounding_indices:
        left, low, right, high = world.bounds
        return np.array([[left, low], [right, low], [right, high], [left, high]]), loops
    room = loops[surrounding_indices[0]]
    if len(surrounding_indices) % 2:
        del loops[surrounding_indices[0]]
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


def body_outline(spec: RobotSpec, points: int = 40) -> Floats:
    """Return the footprint of `spec` as (N, 2) points in base_link."""
    if spec.footprint is not None:
        return np.array(spec.footprint, dtype=np.float64)
    angle = np.linspace(0.0, math.tau, points, endpoint=False)
    return spec.radius * np.column_stack([np.cos(angle), np.sin(angle)])


def nose_outline(spec: RobotSpec) -> Floats:
    """Return the arrowhead on the robot that shows its heading, as (4, 2) points in base_link."""
    reach = float(np.hypot(*body_outline(spec).T).max())
    return reach * np.array([[0.78, 0.0], [-0.45, 0.48], [-0.2, 0.0], [-0.45, -0.48]])


def place(outline: Floats, pose: Pose) -> Floats:
    """Convert `outline`, (N, 2), from base_link to the frame `map`."""
    cosine, sine = math.cos(pose.theta), math.sin(pose.theta)
    x, y = outline.T
    return np.column_stack([pose.x + cosine * x - sine * y, pose.y + sine * x + cosine * y])


def beam_ends(ranges: npt.NDArray[Any], lidar: LidarSpec, pose: Pose) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
    """Return the sensor's position (2,), each beam's end (N, 2) in metres, and whether the beam hit something (N,).

    A beam without a return ends at `range_max`. One whose range is invalid or too short ends at the sensor.
    """
    mount = place(np.array([[lidar.mount.x, lidar.mount.y]]), pose)[0]
    angles = pose.theta + lidar.mount.theta + lidar.angle_min + np.arange(lidar.beams) * lidar.angle_increment
    ranges = np.asarray(ranges, dtype=np.float64)
    has_hit = np.isfinite(ranges)
    length = np.where(has_hit, ranges, np.where(ranges == math.inf, lidar.range_max, 0.0))
    ends = mount + length[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return mount, ends, has_hit


def is_full_turn(lidar: LidarSpec) -> bool:
    """Return whether the beams cover a full turn."""
    return math.isclose(lidar.beams * lidar.angle_increment, math.tau, rel_tol=0.02)


def movers_at(simulation: Simulation, time_ns: int) -> list[tuple[float, float]]:
    """Return the centre of each moving obstacle at `time_ns`, in metres."""
    return [(x, y) for x, y, _ in simulation.scene.movers_at(time_ns)]
