"""The run: `step(simulation, state, commands, dt) -> state`, with no globals and no hidden clock."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from sim.exceptions import SpecError
from sim.lidar import Scan
from sim.pose import Command, Pose
from sim.robot import RobotSpec, RobotState
from sim.world import World

Commands = Mapping[str, Command] | Command | None
Engine = Literal["numpy", "numba", "auto"]


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened: `kind` is "collision", "contact lost", "watchdog" or "fault"; `what` says it in words.

    `x` and `y` are where, in the frame `map`; `speed` in m/s at that moment.
    """

    time_ns: int
    robot: str
    kind: str
    what: str
    x: float
    y: float
    speed: float = 0.0


@dataclass(frozen=True)
class Simulation:
    """What a run is made of: a world, robots, a seed. Nothing in it ever changes.

    `tick` is the physics period in seconds; `engine` is who computes: "numpy", "numba" (the extra `fast`) or
    "auto" (numba where it is installed). All give the same states and the same scans, bit for bit.
    """

    world: World
    robots: tuple[RobotSpec, ...] = (RobotSpec(),)
    seed: int = 0
    tick: float = 0.02
    engine: Engine = "numpy"


@dataclass(frozen=True, slots=True)
class State:
    """The whole of a run at one instant: `tick` physics ticks and `time_ns` nanoseconds after its start.

    `events` are those of the step that led here.
    """

    tick: int
    time_ns: int
    robots: tuple[RobotState, ...]
    events: tuple[Event, ...] = ()


def start(simulation: Simulation) -> State:
    """Return the state at time 0, every robot at rest on its start pose."""
    poses = simulation.world.starts
    robots = []
    for index, spec in enumerate(simulation.robots):
        pose = spec.start or poses[index % len(poses)]
        robots.append(RobotState(name=spec.name, pose=pose, odometry=Pose()))
    return State(tick=0, time_ns=0, robots=tuple(robots))


def step(simulation: Simulation, state: State, commands: Commands = None, dt: float | None = None) -> State:
    """Return the state `dt` seconds later (one physics tick if None), each robot obeying its command.

    `commands` maps a robot's name to its command; with one robot the command alone will do. A robot that is not
    named keeps its last command until its watchdog stops it.
    """
    dt = simulation.tick if dt is None else dt
    ticks = max(1, math.ceil(dt / simulation.tick - 1e-9))
    robots = []
    for spec, robot in zip(simulation.robots, state.robots, strict=True):
        command = commands if isinstance(commands, Command) else (commands or {}).get(spec.name, robot.command)
        v = min(max(command.linear, -spec.max_linear), spec.max_linear)
        w = min(max(command.angular, -spec.max_angular), spec.max_angular)
        turn = w * dt
        chord = v * dt * (math.sin(turn / 2) / (turn / 2) if turn else 1.0)
        pose = robot.pose
        pose = Pose(
            pose.x + chord * math.cos(pose.theta + turn / 2),
            pose.y + chord * math.sin(pose.theta + turn / 2),
            pose.theta + turn,
        )
        robots.append(replace(robot, pose=pose, velocity=Command(v, w), command=command))
    return State(state.tick + ticks, state.time_ns + round(dt * 1e9), tuple(robots))


def observe(simulation: Simulation, state: State, robot: str | None = None) -> Scan | None:
    """Return what the lidar of `robot` (the first if None) sees now; None when a dead lidar sends nothing.

    Raises SpecError for a robot that does not exist or has no lidar.
    """
    index = _index(simulation, robot)
    spec = simulation.robots[index]
    lidar = spec.lidar
    if lidar is None:
        raise SpecError(f"robot {spec.name!r} has no lidar")
    pose = state.robots[index].pose
    angles = pose.theta + lidar.angle_min + np.arange(lidar.beams) * lidar.angle_increment
    dx, dy = np.cos(angles), np.sin(angles)
    best = np.full(lidar.beams, 1e-300)
    for x1, y1, x2, y2 in simulation.world.segments.tolist():
        ex, ey, vx, vy = x2 - x1, y2 - y1, x1 - pose.x, y1 - pose.y
        h = vx * ey - vy * ex
        s1, s2 = dx * vy - dy * vx, dx * (y2 - pose.y) - dy * (x2 - pose.x)
        if h:
            best = np.maximum(best, np.where(s1 * s2 <= 0, (dx * ey - dy * ex) / h, 0.0))
    ranges = (1 / best).astype(np.float32)
    ranges[ranges > lidar.range_max] = np.inf
    ranges[ranges < lidar.range_min] = -np.inf
    return Scan(
        stamp_ns=state.time_ns,
        ranges=ranges,
        intensities=np.empty(0, np.float32),
        angle_min=lidar.angle_min,
        angle_max=lidar.angle_max,
        angle_increment=lidar.angle_increment,
        time_increment=0.0,
        scan_time=1 / lidar.rate,
        range_min=lidar.range_min,
        range_max=lidar.range_max,
    )


@dataclass(frozen=True, slots=True)
class Clearance:
    """How near the nearest obstacle is: `distance` in m from the footprint (below 0: inside it), where, and its name.

    `x` and `y` are the obstacle's nearest point in the frame `map`; `what` reads like "north wall", "wall 3",
    "pillar 0", "mover 1" or "robot bob".
    """

    distance: float
    x: float
    y: float
    what: str


def clearance(simulation: Simulation, state: State, robot: str | None = None) -> Clearance:
    """Return how near the nearest obstacle is to the footprint of `robot` (the first if None)."""
    index = _index(simulation, robot)
    pose, spec, world = state.robots[index].pose, simulation.robots[index], simulation.world
    best = Clearance(math.inf, math.nan, math.nan, "nothing")
    for number, (x1, y1, x2, y2) in enumerate(world.segments.tolist()):
        ex, ey = x2 - x1, y2 - y1
        length = ex * ex + ey * ey
        t = min(max(((pose.x - x1) * ex + (pose.y - y1) * ey) / length, 0.0), 1.0) if length else 0.0
        x, y = x1 + t * ex, y1 + t * ey
        distance = math.hypot(x - pose.x, y - pose.y) - spec.radius
        if distance < best.distance:
            best = Clearance(distance, x, y, world.segment_names[number] or f"wall {number}")
    return best


def _index(simulation: Simulation, robot: str | None) -> int:
    names = [spec.name for spec in simulation.robots]
    if robot is None:
        return 0
    if robot not in names:
        raise SpecError(f"there is no robot {robot!r}; the robots are {', '.join(names)}")
    return names.index(robot)
