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
    """The nearest obstacle, and its `distance` from the robot's footprint in metres, below 0 if the two overlap.

    (`x`, `y`) is the point of the obstacle that is nearest to the robot, in the frame `map`. `name` is the obstacle's
    name, such as "north wall", "wall 3", "pillar 0", "mover 1" or "robot bob". In an empty world, the distance is
    infinite and the point is nan.
    """

    distance: float
    x: float
    y: float
    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """The obstacles within some distance of a point: walls (7, K), circles (M, 3), and the names of all of them."""

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
    contact = np.empty(6)
    gap = simulation.scene.engine.gap(
        pose.x, pose.y, pose.theta, body.shape, obstacles.walls, obstacles.circles, contact
    )
    return Clearance(float(gap), float(contact[1]), float(contact[2]), obstacles.names[int(contact[0])])


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


def obstacles_around(
    simulation: Simulation, time_ns: int, poses: list[Pose], index: int, max_distance: float
) -> Obstacles:
    """Return all obstacles within `max_distance` metres of a robot's centre at a simulated time, and maybe others."""
    scene, world = simulation.scene, simulation.world
    centre = poses[index]
    min_x, max_x, min_y, max_y = scene.boxes
    # It is enough to select walls by their bounding boxes, because a few additional walls do no harm.
    dx = np.maximum(np.maximum(min_x - centre.x, centre.x - max_x), 0.0)
    dy = np.maximum(np.maximum(min_y - centre.y, centre.y - max_y), 0.0)
    near_walls = np.flatnonzero(dx * dx + dy * dy <= max_distance * max_distance).tolist()
    names = [world.segment_names[k] or f"wall {k}" for k in near_walls]
    walls = scene.walls[:, near_walls]
    circles, circle_names = [], []
    for k, (x, y, radius) in enumerate(scene.circles.tolist()):
        if math.hypot(x - centre.x, y - centre.y) - radius <= max_distance:
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
