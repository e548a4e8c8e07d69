"""Worlds drawn from a seed, and the engines that can be compared on them."""

from __future__ import annotations

import math

import numpy as np

from sim import BOX_NAMES, Command, LidarSpec, Mover, Pose, RobotSpec, Simulation, World, box

# Always both: the tests require numba.
ENGINES = ("numpy", "numba")
FULL_TURN = LidarSpec(name="test", range_min=0.0, range_max=30.0)


def random_world(seed: int, walls: int = 20, size: float = 10.0, pillars: int = 3, movers: int = 0) -> World:
    """A square room `size` m wide with random walls and pillars, and perhaps movers."""
    random = np.random.default_rng(seed)
    half = size / 2
    begin = random.uniform(-half, half, (walls, 2))
    angle = random.uniform(0, math.tau, walls)
    length = random.uniform(0.2, size / 5, walls)
    end = begin + length[:, None] * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    return World.from_segments(
        np.vstack((box(size, size), np.hstack((begin, end)))),
        circles=np.column_stack((random.uniform(-half, half, (pillars, 2)), random.uniform(0.05, 0.5, pillars))),
        starts=[Pose(0.1, -0.2, 0.3), Pose(1.5, -1.0, 2.0)],
        movers=[
            Mover(tuple(map(tuple, random.uniform(-half, half, (3, 2)).tolist())), radius=0.2, speed=0.5)
            for _ in range(movers)
        ],
        segment_names=BOX_NAMES + ("",) * walls,
    )


def random_pose(random: np.random.Generator, size: float = 10.0) -> Pose:
    x, y = random.uniform(-size / 2, size / 2, 2).tolist()
    return Pose(x, y, float(random.uniform(-math.pi, math.pi)))


def simulation_at(
    pose: Pose, world: World, engine: str = "numpy", lidar: LidarSpec = FULL_TURN, **robot: object
) -> Simulation:
    """A simulation of one robot that starts at `pose`."""
    return Simulation(world, (RobotSpec(start=pose, lidar=lidar, **robot),), engine=engine)  # type: ignore[arg-type]


def wander(seed: int, names: tuple[str, ...] = ("robot",)):  # type: ignore[no-untyped-def]
    """A policy that ignores its scans and draws commands from a seed."""
    random = np.random.default_rng(seed)

    def policy(state: object, scans: object) -> dict[str, Command]:
        return {name: Command(float(random.uniform(-0.2, 0.5)), float(random.uniform(-2.0, 2.0))) for name in names}

    return policy
