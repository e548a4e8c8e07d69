"""Finds the obstacle nearest to a robot: its distance, its nearest point and its name."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.engine.index import layout
from sim.pose import Pose
from sim.scene import outline
from sim.state import Simulation, State

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Clearance:
    """The nearest obstacle, and its `distance` in m from the robot's footprint, below 0 if it is inside.

    `x` and `y` are the obstacle's nearest point in the frame `map`. `name` is its name, such as "north wall", "wall 3",
    "pillar 0", "mover 1" or "robot bob". In an empty world, the distance is infinite and the point is nan.
    """

    distance: float
    x: float
    y: float
    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """The obstacles within some distance of a point: walls (7, K), circles (M, 3), and the names of all."""

    walls: Floats
    circles: Floats
    names: tuple[str, ...]


def clearance(simulation: Simulation, state: State, robot: str | None = None) -> Clearance:
    """Return the obstacle nearest to a robot's footprint, with its distance.

    Args:
        simulation: the world and its robots.
        state: the current state.
        robot: the name of the robot; the first robot if None.
    """
    index = simulation.number_of(robot)
    pose = state.robots[index].pose
    body = simulation.scene.bodies[index]
    poses = [other.pose for other in state.robots]
    nearest = distance_to_nearest(simulation, state.time_ns, poses, index)
    obstacles = obstacles_around(simulation, state.time_ns, poses, index, nearest + 2.0 * body.reach + 1e-9)
    if not obstacles.names:
        return Clearance(math.inf, math.nan, math.nan, "nothing")
    touch = np.empty(6)
    gap = simulation.scene.engine.gap(pose.x, pose.y, pose.theta, body.shape, obstacles.walls, obstacles.circles, touch)
    return Clearance(float(gap), float(touch[1]), float(touch[2]), obstacles.names[int(touch[0])])


def distance_to_nearest(simulation: Simulation, time_ns: int, poses: list[Pose], index: int) -> float:
    """Return the distance from the centre of a robot to the nearest obstacle, in metres."""
    scene = simulation.scene
    centre = poses[index]
    best = float(scene.engine.nearest(scene.walls, scene.circles, centre.x, centre.y))
    if len(poses) == 1 and not scene.tracks:
        return best
    for x, y, radius in scene.movers_at(time_ns):
        best = min(best, math.hypot(x - centre.x, y - centre.y) - radius)
    for number, pose in enumerate(poses):
        if number != index:
            best = min(best, math.hypot(pose.x - centre.x, pose.y - centre.y) - scene.bodies[number].reach)
    return best


def obstacles_around(simulation: Simulation, time_ns: int, poses: list[Pose], index: int, within: float) -> Obstacles:
    """Return all obstacles within `within` metres of the centre of a robot, and some others, at a simulated time."""
    scene, world = simulation.scene, simulation.world
    centre = poses[index]
    min_x, max_x, min_y, max_y = scene.boxes
    # Walls are selected by their bounding boxes, because a few additional ones do no harm.
    dx = np.maximum(np.maximum(min_x - centre.x, centre.x - max_x), 0.0)
    dy = np.maximum(np.maximum(min_y - centre.y, centre.y - max_y), 0.0)
    near = np.flatnonzero(dx * dx + dy * dy <= within * within).tolist()
    names = [world.segment_names[k] or f"wall {k}" for k in near]
    walls = scene.walls[:, near]
    circles, circle_names = [], []
    for k, (x, y, radius) in enumerate(scene.circles.tolist()):
        if math.hypot(x - centre.x, y - centre.y) - radius <= within:
            circles.append((x, y, radius))
            circle_names.append(world.circle_names[k] or f"pillar {k}")
    for mover, circle in zip(world.movers, scene.movers_at(time_ns), strict=True):
        circles.append(circle)
        circle_names.append(mover.name)
    sides = []
    for number, (spec, pose) in enumerate(zip(simulation.robots, poses, strict=True)):
        if number == index:
            continue
        if spec.footprint is None:
            circles.append((pose.x, pose.y, spec.radius))
            circle_names.append(f"robot {spec.name}")
        else:
            sides += outline(pose, spec)
            names += [f"robot {spec.name}"] * len(spec.footprint)
    if sides:
        walls = np.concatenate((walls, layout(np.array(sides))), axis=1)
    return Obstacles(np.ascontiguousarray(walls), np.array(circles).reshape(-1, 3), (*names, *circle_names))
