"""A world and its robots in the form that an engine needs: columns of numbers, tables of beams and keys of noise."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.engine import EngineName, engine
from sim.engine.index import MAX_WALLS_WITHOUT_GRID, Grid, grid_of, layout
from sim.engine.shapes import distance
from sim.engine.trig import TAU, sincos
from sim.lidar import LidarSpec
from sim.noise import Words, key_of, uniform, words
from sim.pose import Pose
from sim.robot import NO_DRIFT, RobotSpec
from sim.world import Mover, World

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Beams:
    """A lidar's beams: their directions (2, beams) in its frame, the number of beams per radian, and their length."""

    table: Floats
    per_radian: float
    reach: float


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A robot for the engine: its shape (see `engine.shapes`), its limits, its drift and the keys of its noise."""

    shape: Floats
    reach: float
    limits: Floats
    drift: Floats
    watchdog_ns: int
    max_linear: float
    has_drift: bool
    beams: Beams | None
    range_key: Words
    dropout_key: Words
    odometry_key: Words


@dataclass(frozen=True, slots=True)
class Track:
    """A mover's cycle: `legs` of (start time, x, y, velocity x, velocity y, time in motion), in s, m and m/s."""

    legs: tuple[tuple[float, float, float, float, float, float], ...]
    period: float
    offset: float
    radius: float

    def at(self, time_ns: int) -> tuple[float, float]:
        """Return the position of the mover at a simulated time."""
        if self.period <= 0.0:
            return self.legs[0][1], self.legs[0][2]
        t = time_ns / 1e9 + self.offset
        t -= self.period * math.floor(t / self.period)
        leg_start, x, y, vx, vy, travel_time = self.legs[0]
        for leg in self.legs:
            if leg[0] > t:
                break
            leg_start, x, y, vx, vy, travel_time = leg
        elapsed = min(t - leg_start, travel_time)
        return x + vx * elapsed, y + vy * elapsed


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """The data of a run for an engine. `boxes` (4, K) contains the minimum and maximum of x, then y, for each wall."""

    engine: Any
    walls: Floats
    boxes: Floats
    circles: Floats
    grid: Grid | None
    tracks: tuple[Track, ...]
    bodies: tuple[Body, ...]
    mover_speed: float
    may_freeze: bool

    def movers_at(self, time_ns: int) -> list[tuple[float, float, float]]:
        """Return the movers as circles at a simulated time."""
        return [(*track.at(time_ns), track.radius) for track in self.tracks]


def build(world: World, robots: tuple[RobotSpec, ...], seed: int, engine_name: EngineName) -> Scene:
    """Return the scene of a run for the engine called `engine_name`."""
    walls = layout(world.segments)
    selected_engine = engine(engine_name)
    x1, x2, y1, y2 = walls[:4]
    return Scene(
        engine=selected_engine,
        walls=walls,
        boxes=np.array((np.minimum(x1, x2), np.maximum(x1, x2), np.minimum(y1, y2), np.maximum(y1, y2))),
        circles=world.circles.copy(),
        grid=grid_of(walls)
        if walls.shape[1] > MAX_WALLS_WITHOUT_GRID and hasattr(selected_engine, "scan_ranges_in_grid")
        else None,
        tracks=tuple(_track(mover, number, seed) for number, mover in enumerate(world.movers)),
        bodies=tuple(_body(robot, seed) for robot in robots),
        mover_speed=max((mover.speed for mover in world.movers), default=0.0),
        may_freeze=any(robot.faults.frozen for robot in robots),
    )


def beams_of(lidar: LidarSpec) -> Beams:
    """Return the beams of a lidar."""
    angles = [lidar.angle_min + beam * lidar.angle_increment for beam in range(lidar.beams)]
    sines, cosines = zip(*(sincos(angle) for angle in angles), strict=True)
    per_radian = 1.0 / lidar.angle_increment if lidar.beams > 1 else 1.0 / TAU
    return Beams(np.array((cosines, sines)), per_radian, lidar.range_max * 1.000001)


def _body(robot: RobotSpec, seed: int) -> Body:
    corners = robot.footprint or ()
    reach = max((distance(0.0, 0.0, x, y) for x, y in corners), default=robot.radius)
    drift = robot.drift
    return Body(
        shape=np.array([(robot.radius, reach), *corners]),
        reach=reach,
        limits=np.array(
            (robot.max_linear, robot.max_angular, robot.max_linear_acceleration, robot.max_angular_acceleration)
        ),
        drift=np.array((drift.linear**2, drift.angular**2, drift.veer**2)),
        watchdog_ns=round(min(robot.watchdog, 1e9) * 1e9),
        max_linear=robot.max_linear,
        has_drift=drift != NO_DRIFT,
        beams=None if robot.lidar is None else beams_of(robot.lidar),
        range_key=key_of(seed, robot.name, "range"),
        dropout_key=key_of(seed, robot.name, "dropout"),
        odometry_key=key_of(seed, robot.name, "odometry"),
    )


def _track(mover: Mover, number: int, seed: int) -> Track:
    points = [*mover.path, mover.path[0]] if mover.loop else [*mover.path, *mover.path[-2::-1]]
    legs = []
    leg_start = 0.0
    for (x1, y1), (x2, y2) in pairwise(points):
        length = distance(x1, y1, x2, y2)
        travel_time = length / mover.speed
        speed = mover.speed / length if length > 0.0 else 0.0
        legs.append((leg_start, x1, y1, (x2 - x1) * speed, (y2 - y1) * speed, travel_time))
        leg_start += travel_time + mover.pause
    phase = mover.phase
    if phase is None:
        phase = float(uniform(words(key_of(seed, f"{number}/{mover.name}", "phase"), 0, 1))[0])
    return Track(tuple(legs) or ((0.0, *mover.path[0], 0.0, 0.0, 0.0),), leg_start, phase * leg_start, mover.radius)


def outline(pose: Pose, robot: RobotSpec) -> list[tuple[float, float, float, float]]:
    """Return the sides of a polygonal footprint in the frame `map`; there are none for a round one."""
    if robot.footprint is None:
        return []
    s, c = sincos(pose.theta)
    corners = [(pose.x + c * x - s * y, pose.y + s * x + c * y) for x, y in robot.footprint]
    return [(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
