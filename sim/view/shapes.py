"""The shapes of what is drawn, as numbers: outlines of rooms, robots and scans, and a run's closest place.

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
"""Paper around the world's bounds, as a share of its larger side: room for the names of the outer walls."""


@dataclass(frozen=True)
class Moment:
    """A moment of a run that its drawing points at.

    Attributes:
        time: in seconds.
        x, y: where the robot's centre is then.
        near: what is nearest to the robot then.
        words: what is written beside it.
        marked: whether somebody chose the moment; if not, it is the one at which the robot was closest to something.
    """

    time: float
    x: float
    y: float
    near: Clearance
    words: str
    marked: bool

    @property
    def spot(self) -> tuple[float, float]:
        """The place for the words: the chosen one's robot, or the middle of the gap to what is nearest."""
        gap, whole = max(0.0, self.near.distance), math.hypot(self.x - self.near.x, self.y - self.near.y)
        if self.marked or whole == 0.0:
            return self.x, self.y
        share = min(1.0, gap / whole) / 2
        return self.near.x + share * (self.x - self.near.x), self.near.y + share * (self.y - self.near.y)


def moment_of(recording: Recording, indices: list[int], mark: float | None, note: str) -> Moment | None:
    """Return the moment to point at: the chosen one, or where the robot was closest to something.

    Of several robots, or after a collision, which has a symbol of its own, only a chosen moment is pointed at.

    Args:
        recording: the run.
        indices: of the robots that are drawn; the first one's moment is meant.
        mark: the time of the chosen moment, in seconds.
        note: what is said of the chosen moment.

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
        collided = any(event.kind == "collision" and event.robot == spec.name for event in recording.events)
        if len(indices) > 1 or collided or not np.isfinite(distances).any():
            return None
        row = int(np.nanargmin(distances))
        words = f"{max(0.0, float(distances[row])):.2f} m"
    x, y, _ = recording.poses[row, index].tolist()
    near = clearance(recording.simulation, state_at(recording, row), spec.name)
    return Moment(float(recording.times[row]), x, y, near, words, mark is not None)


def margin_of(world: World) -> float:
    """Return the paper around the world's bounds, in metres."""
    left, low, right, high = world.bounds
    return max(0.05, MARGIN * max(right - left, high - low))


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


def movers_at(simulation: Simulation, time_ns: int) -> list[tuple[float, float]]:
    """Return where the centre of each moving obstacle is at `time_ns`, in metres."""
    return [(x, y) for x, y, _ in simulation.scene.movers_at(time_ns)]
