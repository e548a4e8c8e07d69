"""Measure the simulator and, for comparison, ir-sim on one core, in a room of 20 m x 20 m with 40 walls.

A scan is the ray casting alone: exact ranges in double precision for a pose. `observe` adds what a LaserScan needs. The
loop runs physics at 50 Hz and scans at 10 Hz through the public functions, in open space and against a wall. In each of
several rounds, all subjects are measured in turn. A figure is the smallest of the rounds' medians, on which other load
on the machine has little effect.
"""

from __future__ import annotations

import contextlib
import io
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from sim import LDS_01, UTM_30LX, Command, LidarSpec, Pose, RobotSpec, Simulation, World, box, observe, start, step
from sim.engine.index import layout

RANGE = 10.0
FAR_360 = replace(LDS_01, range_max=RANGE)
FAR_1080 = replace(UTM_30LX, beams=1080, range_max=RANGE)
SECONDS = 10.0


def room(walls: int, longest: float, seed: int = 1) -> World:
    """Return a closed room with the given number of walls, half of `longest` to `longest` metres long."""
    random = np.random.default_rng(seed)
    begin = random.uniform(-10, 10, (walls - 4, 2))
    angle = random.uniform(0, math.tau, walls - 4)
    length = random.uniform(longest / 2, longest, walls - 4)
    end = np.clip(begin + length[:, None] * np.stack((np.cos(angle), np.sin(angle)), axis=1), -10, 10)
    return World.from_segments(
        np.vstack((box(20, 20), np.hstack((begin, end)))), starts=[Pose(*open_space(begin, end))]
    )


def open_space(begin: NDArray[np.float64], end: NDArray[np.float64]) -> tuple[float, float]:
    """Return the point of a lattice that is farthest from all walls."""
    lattice = np.stack(np.meshgrid(np.linspace(-9, 9, 37), np.linspace(-9, 9, 37)), axis=-1).reshape(-1, 1, 2)
    edge = end - begin
    t = np.clip(((lattice - begin) * edge).sum(axis=2) / (edge * edge).sum(axis=1), 0, 1)
    distance = np.linalg.norm(lattice - begin - t[..., None] * edge, axis=2).min(axis=1)
    x, y = lattice[distance.argmax(), 0].tolist()
    return x, y


def caster(world: World, lidar: LidarSpec, engine: str) -> Callable[[Pose], object]:
    """Return a function that calls the engine's scan in the same way as `observe`."""
    scene = Simulation(world, (RobotSpec(lidar=lidar),), engine=engine).scene  # type: ignore[arg-type]
    beams = scene.bodies[0].beams
    assert beams is not None
    last_arguments = (lidar.angle_min, beams.per_radian, beams.reach)
    walls, grid = layout(world.segments), scene.grid
    if grid is None:
        return lambda pose: scene.engine.scan_ranges(
            walls, scene.circles, beams.table, pose.x, pose.y, pose.theta, *last_arguments
        )
    cells = (grid.starts, grid.members, grid.west, grid.south, grid.cell, grid.columns, grid.rows)
    return lambda pose: scene.engine.scan_ranges_in_grid(
        walls, *cells, scene.circles, beams.table, pose.x, pose.y, pose.theta, *last_arguments
    )


def observer(world: World, engine: str) -> Callable[[Pose], object]:
    """Return a function that calls `observe`, which computes a LaserScan's fields in single precision."""
    simulation = Simulation(world, (RobotSpec(lidar=FAR_360),), engine=engine)  # type: ignore[arg-type]
    state = start(simulation)
    robot = state.robots[0]
    return lambda pose: observe(simulation, replace(state, robots=(replace(robot, pose=pose),)))


def ir_sim(world: World) -> Callable[[Pose], object]:
    """Return a function that scans the same walls with ir-sim's lidar of 360 beams."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        import irsim

        lidar = {"type": "lidar2d", "range_min": 0, "range_max": RANGE, "angle_range": math.tau, "number": 360}
        robot = {
            "kinematics": {"name": "diff"},
            "shape": {"name": "circle", "radius": 0.1},
            "state": [0, 0, 0],
            "goal": [9, 9],
            "sensors": [{**lidar, "noise": False}],
        }
        walls = [
            {"shape": {"name": "linestring", "vertices": [[x1, y1], [x2, y2]]}, "state": [0, 0, 0]}
            for x1, y1, x2, y2 in world.segments.tolist()
        ]
        size = {"width": 20, "height": 20, "offset": [-10, -10]}
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "world.yaml"
            path.write_text(yaml.safe_dump({"world": size, "robot": [robot], "obstacle": walls}), encoding="utf-8")
            environment = irsim.make(str(path), display=False, disable_all_plot=True, log_level="ERROR")
    sensor = environment.robot.lidar
    return lambda pose: sensor.step(np.array([[pose.x], [pose.y], [pose.theta]]))


def loop(world: World, engine: str, seconds: float, turn: float = 0.8) -> Callable[[], object]:
    """Return a function that drives in a circle or straight on, with a scan, a command and five ticks every 0.1 s."""
    simulation = Simulation(world, (RobotSpec(lidar=FAR_360),), engine=engine)  # type: ignore[arg-type]
    first = start(simulation)
    command = Command(0.2, turn)

    def drive() -> object:
        state = first
        for _ in range(round(seconds * 10)):
            observe(simulation, state)
            state = step(simulation, state, command, 0.1)
        return state

    return drive


def median_us(call: Callable[[Pose], object], poses: list[Pose], calls: int) -> float:
    """Return the time of one call in microseconds, as the median over some poses."""
    times = []
    for pose in poses:
        begin = time.perf_counter()
        for _ in range(calls):
            call(pose)
        times.append((time.perf_counter() - begin) / calls * 1e6)
    return statistics.median(times)


def import_cost() -> tuple[float, float]:
    """Return the seconds and the peak megabytes of `import sim` in a new process, including numpy."""
    script = (
        "import time; t = time.perf_counter(); import sim; s = time.perf_counter() - t; "
        "peak = next(line for line in open('/proc/self/status') if line.startswith('VmHWM')); "
        "print(s, int(peak.split()[1]) / 1024)"
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    process = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    seconds, megabytes = map(float, process.stdout.split())
    return seconds, megabytes


def figures(
    rounds: int = 15, poses_per_round: int = 15, seconds: float = SECONDS, *, compare: bool = True
) -> dict[str, float]:
    """Return all figures, each the best of several rounds.

    Args:
        rounds: the number of times that everything is measured.
        poses_per_round: the number of poses in each round.
        seconds: the simulated duration of each loop.
        compare: whether ir-sim, which only `make bench` installs, is also measured.
    """
    small, large = room(40, 4.0), room(10_000, 0.4)
    random = np.random.default_rng(2)
    poses = [Pose(*row) for row in random.uniform((-9, -9, -3), (9, 9, 3), (poses_per_round, 3)).tolist()]
    subjects: dict[str, tuple[Callable[[Pose], object], int]] = {
        "sim.scan360_numpy_us": (caster(small, FAR_360, "numpy"), 10),
        "sim.scan360_numba_us": (caster(small, FAR_360, "numba"), 100),
        "sim.scan1080_numpy_us": (caster(small, FAR_1080, "numpy"), 10),
        "sim.scan1080_numba_us": (caster(small, FAR_1080, "numba"), 100),
        "sim.scan360_10k_numba_us": (caster(large, FAR_360, "numba"), 20),
        "sim.observe360_numpy_us": (observer(small, "numpy"), 10),
        "sim.observe360_numba_us": (observer(small, "numba"), 50),
    }
    if compare:
        subjects["sim.scan360_irsim_us"] = (ir_sim(small), 1)
    loops = {f"sim.loop_{engine}_rtf": loop(small, engine, seconds) for engine in ("numpy", "numba")}
    closet = World.from_segments(box(1.0, 1.0).tolist(), name="a closet")  # a robot soon touches its wall
    loops |= {f"sim.contact_{engine}_rtf": loop(closet, engine, seconds, turn=0.0) for engine in ("numpy", "numba")}
    for call, _ in subjects.values():  # compiles the functions, and warms the caches
        call(poses[0])
    best_us = dict.fromkeys(subjects, math.inf)
    best_seconds = dict.fromkeys(loops, math.inf)
    for _ in range(rounds):
        for name, (call, calls) in subjects.items():
            best_us[name] = min(best_us[name], median_us(call, poses, calls))
        for name, drive in loops.items():
            begin = time.perf_counter()
            drive()
            best_seconds[name] = min(best_seconds[name], time.perf_counter() - begin)
    results = {**best_us, **{name: seconds / elapsed for name, elapsed in best_seconds.items()}}
    if compare:
        results["sim.irsim_ratio"] = results["sim.scan360_irsim_us"] / results["sim.scan360_numba_us"]
        results["sim.irsim_numpy_ratio"] = results["sim.scan360_irsim_us"] / results["sim.scan360_numpy_us"]
    results["sim.index_cost_ratio"] = results["sim.scan360_10k_numba_us"] / results["sim.scan360_numba_us"]
    costs = [import_cost() for _ in range(min(rounds, 5))]
    results["sim.import_s"] = min(cost[0] for cost in costs)
    results["sim.import_mb"] = min(cost[1] for cost in costs)
    return results
