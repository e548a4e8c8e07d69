"""How near the nearest obstacle is to a robot, where, and what it is called."""

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
    """How near the nearest obstacle is: `distance` in m from the footprint (below 0: inside it), where, and its name.

    `x` and `y` are the obstacle's nearest point in the frame `map`; `what` reads like "north wall", "wall 3",
    "pillar 0", "mover 1" or "robot bob". In an empty world the distance is infinite, and the point nan.
    """

    distance: float
    x: float
    y: float
    what: str


@dataclass(frozen=True, slots=True, eq=False)
class Around:
    """What is within some distance of a point: walls (7, K), circles (M, 3), and what each is called."""

    walls: Floats
    circles: Floats
    names: tuple[str, ...]


def clearance(simulation: Simulation, state: State, robot: str | None = None) -> Clearance:
    """Return how near the nearest obstacle is to a robot's footprint.

    Args:
        simulation: the world and its robots.
        state: the present one.
        robot: its name; the first robot if None.
    """
    index = simulation.number_of(robot)
    pose = state.robots[index].pose
    body = simulation.scene.bodies[index]
    poses = [other.pose for other in state.robots]
    nearest = nearest_of(simulation, state.time_ns, poses, index)
    things = around(simulation, state.time_ns, poses, index, nearest + 2.0 * body.reach + 1e-9)
    if not things.names:
        return Clearance(math.inf, math.nan, math.nan, "nothing")
    touch = np.empty(6)
    gap = simulation.scene.engine.gap(pose.x, pose.y, pose.theta, body.shape, things.walls, things.circles, touch)
    return Clearance(float(gap), float(touch[1]), float(touch[2]), things.names[int(touch[0])])


def nearest_of(simulation: Simulation, time_ns: int, poses: list[Pose], index: int) -> float:
    """Return how far the centre of a robot is from the nearest obstacle, in metres."""
    scene = simulation.scene
    here = poses[index]
    best = float(scene.engine.nearest(scene.walls, scene.circles, here.x, here.y))
    if len(poses) == 1 and not scene.tracks:
        return best
    for x, y, radius in scene.movers_at(time_ns):
        best = min(best, math.hypot(x - here.x, y - here.y) - radius)
    for number, pose in enumerate(poses):
        if number != index:
            best = min(best, math.hypot(pose.x - here.x, pose.y - here.y) - scene.bodies[number].reach)
    return best


def around(simulation: Simulation, time_ns: int, poses: list[Pose], index: int, within: float) -> Around:
    """Return what may be within `within` metres of the centre of a robot, with movers as they are at that time."""
    scene, world = simulation.scene, simulation.world
    here = poses[index]
    least_x, most_x, least_y, most_y = scene.boxes
    # each wall's box is enough: a few too many do no harm
    dx = np.maximum(np.maximum(least_x - here.x, here.x - most_x), 0.0)
    dy = np.maximum(np.maximum(least_y - here.y, here.y - most_y), 0.0)
    near = np.flatnonzero(dx * dx + dy * dy <= within * within).tolist()
    names = [world.segment_names[k] or f"wall {k}" for k in near]
    chosen = scene.walls[:, near]
    circles, circle_names = [], []
    for k, (x, y, radius) in enumerate(scene.circles.tolist()):
        if math.hypot(x - here.x, y - here.y) - radius <= within:
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
        chosen = np.concatenate((chosen, layout(np.array(sides))), axis=1)
    return Around(np.ascontiguousarray(chosen), np.array(circles).reshape(-1, 3), (*names, *circle_names))
