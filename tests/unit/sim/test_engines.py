"""Both engines, any order of calls and any division of time give the same bits."""

from __future__ import annotations

import copy
import hashlib
import math
import os
import pickle
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim import (
    LDS_01,
    UTM_30LX,
    Command,
    EngineError,
    LidarSpec,
    OdometryDrift,
    Pose,
    RobotSpec,
    Simulation,
    State,
    World,
    cast,
    directions,
    observe,
    run,
    start,
    step,
)
from sim.engine import arrays, engine, loops, motion, shapes, traverse
from sim.engine.index import grid_of, layout
from sim.scene import beams_of
from tests.unit.sim.worlds import ENGINES, FULL_TURN, random_pose, random_world, simulation_at, wander

SQUARE = ((-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1))
# The hash of the scans of `golden`, the same on every machine.
GOLDEN = "fce9484f7817df2924302ac482de20974748198a9b9bce93149d1ea2a170cb3b"


def simulation(name: str, **robot: Any) -> Simulation:
    lidar = replace(LDS_01, noise=0.01, dropout=0.02, mount=Pose(0.03, 0.01, 0.2))
    robots = [
        RobotSpec(name=f"r{number}", lidar=lidar, drift=OdometryDrift(0.02, 0.03, 0.01), **robot) for number in range(2)
    ]
    return Simulation(random_world(5, movers=2), tuple(robots), seed=7, engine=name)  # type: ignore[arg-type]


@pytest.mark.parametrize("robot", [{}, {"on_collision": "slide"}, {"footprint": SQUARE}])
def test_both_engines_record_the_same_run_bit_for_bit(robot: dict[str, Any]) -> None:
    hashes = {run(simulation(name, **robot), wander(3, ("r0", "r1")), 20.0).sha256() for name in ENGINES}
    assert len(hashes) == 1


def golden(name: str) -> str:
    """Return the hash of the float32 scans of a run that uses every feature."""
    recording = run(simulation(name), wander(11, ("r0", "r1")), 10.0)
    digest = hashlib.sha256()
    for log in recording.scans:
        digest.update(log.ranges.astype("<f4").tobytes())
    return digest.hexdigest()


@pytest.mark.parametrize("name", ENGINES)
def test_the_scans_are_the_same_bits_on_every_machine(name: str) -> None:
    """Only correctly rounded operations lead from the seed to the scan, so the processor makes no difference."""
    assert golden(name) == GOLDEN


@pytest.mark.parametrize("name", ["numpy", pytest.param("numba", marks=pytest.mark.nightly)])
def test_a_processor_without_vector_units_or_fused_multiply_add_computes_the_same_scans(
    name: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """numpy's, numba's and the C library's fast paths are switched off in a separate process."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(request.config.rootpath),
        "NPY_DISABLE_CPU_FEATURES": " ".join(import_module("numpy._core._multiarray_umath").__cpu_dispatch__),
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F",
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(tmp_path),
    }
    script = f"from tests.unit.sim.test_engines import golden; print(golden({name!r}))"
    completed = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", script], env=environment, capture_output=True, text=True, check=False
    )
    assert completed.stdout.strip() == GOLDEN, completed.stderr


@pytest.mark.parametrize("lidar", [LDS_01, UTM_30LX, LidarSpec(beams=7, angle_min=-1.0, angle_increment=0.11)])
def test_both_engines_cast_the_same_fans_of_beams(lidar: LidarSpec) -> None:
    random = np.random.default_rng(9)
    world = random_world(1, walls=40)
    for number in range(150):
        pose = random_pose(random)
        if number % 3 == 0:  # in line with walls, at beams through corners
            pose = Pose(float(round(pose.x)), float(round(pose.y)), 0.0)
        ranges = [cast(simulation_at(pose, world, name), pose, lidar) for name in ENGINES]
        np.testing.assert_array_equal(ranges[0], ranges[1])


def test_single_beams_and_fans_agree_bit_for_bit() -> None:
    random = np.random.default_rng(10)
    world = random_world(2)
    walls, beams = layout(world.segments), beams_of(FULL_TURN)
    for _ in range(20):
        pose = random_pose(random)
        fan = cast(simulation_at(pose, world), pose, FULL_TURN)
        origins = np.tile([pose.x, pose.y], (FULL_TURN.beams, 1))
        for name in ENGINES:
            singles = engine(name).beam_ranges(walls, world.circles.copy(), origins, directions(pose, FULL_TURN))  # type: ignore[arg-type]
            np.testing.assert_array_equal(np.where(singles > FULL_TURN.range_max, np.inf, singles), fan)
        plain = loops.scan_ranges(
            walls, world.circles, beams.table, pose.x, pose.y, pose.theta, 0.0, beams.per_radian, 30.0
        )
        np.testing.assert_array_equal(np.where(plain > FULL_TURN.range_max, np.inf, plain), fan)


def test_leaving_out_walls_out_of_range_does_not_change_a_scan() -> None:
    world = random_world(3, walls=900, size=30.0)
    random = np.random.default_rng(5)
    for _ in range(40):
        pose = random_pose(random, 30.0)
        near, far = (
            cast(simulation_at(pose, world, lidar=lidar), pose, lidar)
            for lidar in (replace(FULL_TURN, range_max=3.0), FULL_TURN)
        )
        np.testing.assert_array_equal(near, np.where(far > 3.0, np.inf, far))


@pytest.mark.parametrize("walls", [301, 3000])
def test_the_grid_does_not_change_a_bit_of_a_scan(walls: int) -> None:
    world = random_world(3, walls=walls, size=30.0)
    assert simulation_at(Pose(), world, "numba").scene.grid is not None
    assert simulation_at(Pose(), world, "numpy").scene.grid is None
    random = np.random.default_rng(4)
    simulations = [simulation_at(Pose(), world, name) for name in ENGINES]
    for number in range(60):
        pose = random_pose(random, 34.0)  # from outside, too
        if number % 3 == 0:
            pose = Pose(float(round(pose.x)), float(round(pose.y)), 0.0)
        first, second = (cast(simulation, pose, FULL_TURN) for simulation in simulations)
        np.testing.assert_array_equal(first, second)


def test_every_cell_of_the_grid_lists_the_walls_that_cross_it() -> None:
    walls = layout(random_world(8, walls=400).segments)
    grid = grid_of(walls)
    for wall in range(walls.shape[1]):
        x1, x2, y1, y2 = walls[:4, wall].tolist()
        for t in np.linspace(0.0, 1.0, 50).tolist():
            column = int((x1 + t * (x2 - x1) - grid.west) / grid.cell)
            row = int((y1 + t * (y2 - y1) - grid.south) / grid.cell)
            cell = row * grid.columns + column
            assert wall in grid.members[grid.starts[cell] : grid.starts[cell + 1]]


def test_the_order_of_observations_does_not_matter() -> None:
    subject = simulation("numpy")
    states = [start(subject)]
    for _ in range(5):
        states.append(step(subject, states[-1], {"r0": Command(0.3, 0.5)}, 0.1))

    def bits(state: State, robot: str) -> bytes:
        scan = observe(subject, state, robot)
        assert scan is not None
        return scan.ranges.tobytes()

    forwards = {(index, robot): bits(states[index], robot) for index in range(6) for robot in ("r0", "r1")}
    backwards = {(index, robot): bits(states[index], robot) for robot in ("r1", "r0") for index in reversed(range(6))}
    assert forwards == backwards


@pytest.mark.parametrize("name", ENGINES)
def test_one_long_step_has_the_same_end_as_many_short_ones(name: str) -> None:
    subject = simulation(name)
    commands = {"r0": Command(0.4, 0.7), "r1": Command(0.3, -0.2)}
    long = step(subject, start(subject), commands, 1.0)
    short = step(subject, start(subject), commands)
    while short.time_ns < long.time_ns:
        short = step(subject, short)
    assert short.robots == long.robots
    assert short.tick == long.tick == 50


def test_the_compiled_sources_run_interpreted_too() -> None:
    walls = layout(random_world(6).segments)
    grid = grid_of(walls)
    circles = np.array([[1.0, 1.0, 0.3]])
    beams = beams_of(FULL_TURN)
    arguments = (circles, beams.table, 0.3, 0.4, 0.5, 0.0, beams.per_radian, beams.reach)
    through_grid = traverse.scan_ranges_in_grid(
        walls, grid.starts, grid.members, grid.west, grid.south, grid.cell, grid.columns, grid.rows, *arguments
    )
    np.testing.assert_array_equal(through_grid, arrays.scan_ranges(walls, *arguments))
    assert math.isclose(shapes.nearest(walls, circles, 0.3, 0.4), arrays.nearest(walls, circles, 0.3, 0.4))
    robot = np.zeros(14)
    moved_robot = robot.copy()
    limits, drift, noise = np.array([1.0, 1.0, 9.0, 9.0]), np.zeros(3), np.zeros((4, 2))
    motion.advance_unobstructed(robot, 0.5, 0.3, 4, 0.02, limits, drift, noise)
    arrays.advance_unobstructed(moved_robot, 0.5, 0.3, 4, 0.02, limits, drift, noise)
    np.testing.assert_array_equal(robot, moved_robot)


def test_an_unknown_engine_is_refused_by_name() -> None:
    with pytest.raises(EngineError, match="no engine 'cuda'; use 'numpy', 'numba' or 'auto'"):
        Simulation(World(), engine="cuda")  # type: ignore[arg-type]


def test_a_missing_engine_is_reported_with_the_way_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sim.engine.compiled", None)
    monkeypatch.delattr("sim.engine.compiled", raising=False)
    with pytest.raises(EngineError, match=r"pip install .*fast.*, or use engine='numpy'"):
        engine("numba")


def test_auto_uses_numba_if_it_is_installed() -> None:
    assert engine("auto") is engine("numba")


@pytest.mark.parametrize("name", ENGINES)
def test_a_simulation_that_has_run_can_be_copied_and_sent_to_another_process(name: str) -> None:
    subject = simulation(name)
    state = step(subject, start(subject), {"r0": Command(0.3, 0.5)}, 0.3)
    for duplicate in (copy.deepcopy(subject), pickle.loads(pickle.dumps(subject))):
        assert step(duplicate, start(duplicate), {"r0": Command(0.3, 0.5)}, 0.3) == state
