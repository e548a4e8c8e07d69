"""The course's worlds: a robot fits on every start and goal, and can get from one to the other."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sim import Pose, RobotSpec, Simulation, World
from sim.engine import arrays
from sim.engine.index import layout
from sim.maps import load
from sim.view.shapes import movers_at

WORLDS = Path(__file__).resolve().parents[3] / "assets" / "worlds"
NAMES = sorted(path.stem for path in WORLDS.glob("*.yaml"))
TRACED = {name for name in NAMES if "image:" in (WORLDS / f"{name}.yaml").read_text()}  # maps: walls without names
CELL = 0.1
MARGIN = 0.05  # metres between the robot and the walls on its way


def distance_in(world: World) -> Callable[[float, float], float]:
    """Return a function that gives the distance of the robot's body at (x, y) from all static obstacles."""
    walls, body = layout(world.segments), RobotSpec().radius
    return lambda x, y: float(arrays.nearest(walls, world.circles, x, y)) - body


def reachable(world: World, start_pose: Pose) -> set[tuple[int, int]]:
    """Return the cells that a robot can reach, `CELL` wide and counted from the start pose."""
    distance, reached, waiting = distance_in(world), {(0, 0)}, deque([(0, 0)])
    while waiting:
        i, j = waiting.popleft()
        for cell in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            if cell not in reached and distance(start_pose.x + cell[0] * CELL, start_pose.y + cell[1] * CELL) > MARGIN:
                reached.add(cell)
                waiting.append(cell)
    return reached


@pytest.mark.parametrize("name", NAMES)
def test_a_robot_fits_on_every_start_and_goal(name: str) -> None:
    world = load(WORLDS / f"{name}.yaml")
    distance = distance_in(world)
    for x, y in [(start.x, start.y) for start in world.starts] + [(goal.x, goal.y) for goal in world.goals]:
        assert distance(x, y) > 0.25


@pytest.mark.parametrize("name", [name for name in NAMES if name not in TRACED])
def test_every_goal_can_be_reached_from_the_first_start(name: str) -> None:
    world = load(WORLDS / f"{name}.yaml")
    start_pose = world.starts[0]
    cells = np.array(sorted(reachable(world, start_pose))) * CELL + (start_pose.x, start_pose.y)
    assert world.goals
    for goal in world.goals:
        assert np.hypot(*(cells - (goal.x, goal.y)).T).min() < goal.radius


@pytest.mark.parametrize("name", NAMES)
def test_moving_obstacles_walk_through_no_wall(name: str) -> None:
    world = load(WORLDS / f"{name}.yaml")
    distance, body = distance_in(world), RobotSpec().radius
    for second in np.arange(0.0, 60.0, 0.25):
        positions = movers_at(Simulation(world), int(second * 1e9))
        for mover, (x, y) in zip(world.movers, positions, strict=True):
            assert distance(x, y) + body - mover.radius > 0.02


@pytest.mark.parametrize("name", [name for name in NAMES if name not in TRACED])
def test_every_wall_and_pillar_has_a_name(name: str) -> None:
    world = load(WORLDS / f"{name}.yaml")
    assert all(world.segment_names)
    assert all(world.circle_names)
