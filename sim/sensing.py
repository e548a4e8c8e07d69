"""Simulates lidars: makes scans from the engine's ranges, with noise, drop-outs and faults."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sim.engine.index import layout
from sim.engine.motion import along_arc
from sim.engine.trig import TAU, sincos
from sim.exceptions import SpecError
from sim.faults import DeadSector
from sim.lidar import LidarSpec, Scan
from sim.noise import normal, uniform, words
from sim.pose import ORIGIN, Pose
from sim.robot import RobotSpec
from sim.scene import Body, Scene, beams_of, outline
from sim.state import Simulation, State
from sim.world import MIN_METRES

Floats = NDArray[np.float64]
NO_NOISE = np.empty(0)


def observe(simulation: Simulation, state: State, robot: str | None = None) -> Scan | None:
    """Return the scan of a robot's lidar in a state, or None if the lidar is dead.

    The scan depends only on the simulation and the state, not on earlier calls or on the engine.

    Args:
        simulation: the world and its robots.
        state: the current state.
        robot: the name of the robot; the first robot if None.

    Raises:
        SpecError: the robot does not exist or has no lidar.
    """
    index = simulation.number_of(robot)
    spec = simulation.robots[index]
    lidar = spec.lidar
    if lidar is None:
        raise SpecError(f"robot {spec.name!r} has no lidar; give its RobotSpec one")
    faults = spec.faults
    time_ns = state.time_ns
    if faults.dead and any(window.holds(time_ns) for window in faults.dead):
        return None
    measured_state = state.robots[index].held or state
    body = simulation.scene.bodies[index]
    distances = _ranges(simulation, measured_state, index, lidar, body)
    noise = normal(words(body.range_key, measured_state.tick, lidar.beams)) if lidar.noise > 0.0 else NO_NOISE
    ranges, intensities = simulation.scene.engine.to_readings(
        distances, noise, lidar.noise, lidar.range_min, lidar.range_max, lidar.intensities
    )
    if lidar.dropout > 0.0 or faults.sectors:
        is_lost = _lost_beams(lidar, body, measured_state.tick, time_ns, faults.sectors)
        ranges[is_lost] = np.nan
        if lidar.intensities:
            intensities[is_lost] = 0.0
    ranges.flags.writeable = False
    intensities.flags.writeable = False
    sweep_ns = 0
    time_increment = 0.0
    if lidar.skew:
        time_increment = lidar.time_increment
        # A LaserScan has the increment as float32. Rounded up, so that no beam is later than the state.
        sweep_ns = math.ceil((lidar.beams - 1) * float(np.float32(time_increment)) * 1e9)
    return Scan(
        max(time_ns - sweep_ns, 0),
        ranges,
        intensities,
        lidar.angle_min,
        lidar.angle_max,
        lidar.angle_increment,
        time_increment,
        1.0 / lidar.rate,
        lidar.range_min,
        lidar.range_max,
    )


def cast(simulation: Simulation, pose: Pose, lidar: LidarSpec) -> Floats:
    """Return the exact distances (beams,) in metres, float64, that a lidar would measure.

    Args:
        simulation: the world.
        pose: the pose of the lidar, in the frame `map`.
        lidar: the lidar's beams and range.

    Movers are at their positions at time 0. A distance beyond `range_max` is `inf`. A beam starts at the pose, and its
    direction is the one in `directions(pose, lidar)`. A wall is a closed segment, and a circle a solid disc. Numbers
    below 1e-60 are treated as zero.
    """
    scene = simulation.scene
    ranges = _fan_ranges(scene, scene.walls, _circles(scene, scene.movers_at(0)), pose, lidar)
    ranges[ranges > lidar.range_max] = np.inf
    return ranges


def directions(pose: Pose, lidar: LidarSpec) -> Floats:
    """Return the directions (beams, 2) of the beams in the frame `map`: the same doubles that the engines use."""
    s, c = sincos(zero_if_tiny(pose.theta))
    x, y = beams_of(lidar).table
    return np.stack((c * x - s * y, s * x + c * y), axis=1)


def sensor_pose(pose: Pose, mount: Pose) -> Pose:
    """Return the pose in `map` of a sensor with the pose `mount` in `base_link`, for a robot at `pose`."""
    if mount is ORIGIN:  # the usual case, in which the sums below would give the same result
        return pose
    s, c = sincos(pose.theta)
    return Pose(pose.x + (c * mount.x - s * mount.y), pose.y + (s * mount.x + c * mount.y), pose.theta + mount.theta)


def zero_if_tiny(value: float) -> float:
    """Return the value, or 0 if it is so small that products would underflow."""
    return value if abs(value) >= MIN_METRES else 0.0


def _ranges(simulation: Simulation, state: State, index: int, lidar: LidarSpec, body: Body) -> Floats:
    scene = simulation.scene
    robot = state.robots[index]
    walls, circles = scene.walls, scene.circles
    extra_circles: list[tuple[float, float, float]] = scene.movers_at(state.time_ns) if scene.tracks else []
    if len(simulation.robots) > 1:
        sides = []
        for number, (spec, other) in enumerate(zip(simulation.robots, state.robots, strict=True)):
            if number != index:
                sides += outline(other.pose, spec)
                extra_circles += _disc(other.pose, spec)
        if sides:
            walls = np.concatenate((walls, layout(np.array(sides))), axis=1)
    if extra_circles:
        circles = _circles(scene, extra_circles)
    if lidar.skew:
        return _skewed_ranges(
            scene, walls, circles, robot.pose, robot.velocity.linear, robot.velocity.angular, lidar, body
        )
    return _fan_ranges(scene, walls, circles, sensor_pose(robot.pose, lidar.mount), lidar, body)


def _disc(pose: Pose, spec: RobotSpec) -> list[tuple[float, float, float]]:
    return [(pose.x, pose.y, spec.radius)] if spec.footprint is None else []


def _circles(scene: Scene, extra_circles: Sequence[tuple[float, float, float]]) -> Floats:
    return np.concatenate((scene.circles, np.array(extra_circles))) if extra_circles else scene.circles


def _fan_ranges(
    scene: Scene, walls: Floats, circles: Floats, lidar_pose: Pose, lidar: LidarSpec, body: Body | None = None
) -> Floats:
    beams = beams_of(lidar) if body is None or body.beams is None else body.beams
    grid = scene.grid
    origin = (zero_if_tiny(lidar_pose.x), zero_if_tiny(lidar_pose.y), zero_if_tiny(lidar_pose.theta))
    arguments = (circles, beams.table, *origin, lidar.angle_min, beams.per_radian, beams.reach)
    ranges: Floats
    if grid is None or walls is not scene.walls:
        ranges = scene.engine.scan_ranges(walls, *arguments)
    else:
        ranges = scene.engine.scan_ranges_in_grid(
            walls, grid.starts, grid.members, grid.west, grid.south, grid.cell, grid.columns, grid.rows, *arguments
        )
    return ranges


def _skewed_ranges(
    scene: Scene, walls: Floats, circles: Floats, pose: Pose, v: float, w: float, lidar: LidarSpec, body: Body
) -> Floats:
    """Return the ranges of beams measured one after the other at constant velocity, the last one at this instant."""
    beams = body.beams or beams_of(lidar)
    origins = np.empty((lidar.beams, 2))
    ray_directions = np.empty((lidar.beams, 2))
    for beam, (bx, by) in enumerate(beams.table.T.tolist()):
        seconds_before = (lidar.beams - 1 - beam) * lidar.time_increment
        at = sensor_pose(Pose(*along_arc(pose.x, pose.y, pose.theta, v, w, -seconds_before)), lidar.mount)
        s, c = sincos(at.theta)
        origins[beam] = zero_if_tiny(at.x), zero_if_tiny(at.y)
        ray_directions[beam] = c * bx - s * by, s * bx + c * by
    ranges: Floats = scene.engine.beam_ranges(walls, circles, origins, ray_directions)
    return ranges


def _lost_beams(
    lidar: LidarSpec, body: Body, tick: int, time_ns: int, sectors: Sequence[DeadSector]
) -> NDArray[np.bool_]:
    """Return which beams are lost, by chance or in a dead sector."""
    is_lost = np.zeros(lidar.beams, dtype=np.bool_)
    if lidar.dropout > 0.0:
        is_lost |= uniform(words(body.dropout_key, tick, lidar.beams)) < lidar.dropout
    for sector in sectors:
        if sector.window.holds(time_ns):
            angles = lidar.angle_min + np.arange(lidar.beams) * lidar.angle_increment - sector.first
            is_lost |= angles - TAU * np.floor(angles / TAU) <= sector.width
    return is_lost


def scan_angles(scan: Scan) -> Floats:
    """Return the angle of each beam of a scan in radians, frame `laser`, in [-pi, pi): 0 is straight ahead."""
    angles = scan.angle_min + np.arange(len(scan.ranges)) * scan.angle_increment
    wrapped_angles: Floats = angles - TAU * np.floor((angles + math.pi) / TAU)
    return wrapped_angles
