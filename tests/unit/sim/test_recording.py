"""A recording is complete, is saved, loaded and replayed to the same bits, and is refused if it is damaged."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sim import (
    LDS_01,
    Command,
    DeadSector,
    Faults,
    OdometryDrift,
    Pose,
    Recorder,
    Recording,
    RecordingError,
    RobotSpec,
    Simulation,
    Window,
    clearance,
    load_recording,
    observe,
    replay,
    run,
    start,
    step,
)
from tests.unit.sim.worlds import ENGINES, random_world, wander


def full_simulation(engine: str = "numpy") -> Simulation:
    faults = Faults((Window(1.0, 1.5),), (Window(2.0, 3.0),), (DeadSector(0.1, 0.4, Window(0.5)),))
    square = ((-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1))
    robots = (
        RobotSpec(name="a", lidar=replace(LDS_01, noise=0.01), drift=OdometryDrift(0.01, 0.02, 0.0), faults=faults),
        RobotSpec(name="b", footprint=square, start=Pose(0.5, 0.5, 1.0), lidar=None, on_collision="slide"),
    )
    return Simulation(random_world(12, movers=2), robots, seed=3, engine=engine)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def recording() -> Recording:
    return run(full_simulation(), wander(4, ("a", "b")), 6.0)


@pytest.fixture
def saved_path(recording: Recording, tmp_path: Path) -> Path:
    path = tmp_path / "run.npz"
    recording.save(path)
    return path


def test_a_recording_has_a_row_for_every_state(recording: Recording) -> None:
    assert len(recording) == 61
    assert recording.times[-1] == 6.0
    assert recording.poses.shape == (61, 2, 3)
    assert recording.commands.shape == recording.velocities.shape == (61, 2, 2)
    assert recording.covariances.shape == (61, 2, 9)
    assert np.isnan(recording.commands[0]).all()
    assert recording.clearances.shape == recording.collided.shape == (61, 2)


def test_a_failed_lidar_leaves_no_scan_in_the_recording(recording: Recording) -> None:
    rows = recording.scans[0].rows.tolist()
    assert rows == [row for row in range(60) if not 10 <= row < 15]
    assert recording.scans[0].ranges.shape == (55, 360)
    assert recording.scans[1].ranges.shape == (0, 0)


def test_a_saved_recording_loads_to_the_same_bits(recording: Recording, saved_path: Path) -> None:
    loaded = load_recording(saved_path)
    assert loaded.sha256() == recording.sha256()
    assert loaded.events == recording.events
    assert loaded.simulation.robots == recording.simulation.robots
    assert saved_path.stat().st_size < 120_000


@pytest.mark.parametrize("engine", ENGINES)
def test_a_replay_computes_every_state_again(recording: Recording, saved_path: Path, engine: Any) -> None:
    states = list(replay(load_recording(saved_path), engine=engine))
    poses = [[(r.pose.x, r.pose.y, r.pose.theta) for r in state.robots] for state in states]
    np.testing.assert_array_equal(np.array(poses), recording.poses)
    assert [state.time_ns for state in states] == recording.times_ns.tolist()
    covariances = [[r.covariance for r in state.robots] for state in states]
    np.testing.assert_array_equal(np.array(covariances), recording.covariances)
    log = recording.scans[0]
    for row, ranges in zip(log.rows.tolist(), log.ranges, strict=True):
        scan = observe(replace(recording.simulation, engine=engine), states[row], "a")
        assert scan is not None
        np.testing.assert_array_equal(scan.ranges, ranges)


def test_the_hash_differs_between_runs_and_not_between_engines(recording: Recording) -> None:
    same = run(full_simulation("numba"), wander(4, ("a", "b")), 6.0)
    other = run(full_simulation(), wander(5, ("a", "b")), 6.0)
    assert same.sha256() == recording.sha256() != other.sha256()


def test_a_recorder_stores_commands_and_ticks_without_a_command() -> None:
    simulation = Simulation(random_world(1), (RobotSpec(name="a", watchdog=math.inf),))
    recorder = Recorder(simulation)
    state = step(simulation, start(simulation), Command(0.2, 0.1), 0.1)
    recorder.append(state, Command(0.2, 0.1))
    state = step(simulation, state, None, 0.25)
    recorder.append(state)
    recording = recorder.recording()
    np.testing.assert_array_equal(recording.commands[1:, 0], [[0.2, 0.1], [np.nan, np.nan]])
    assert recording.times_ns.tolist() == [0, 100_000_000, 350_000_000]
    assert recording.clearances[-1, 0] == clearance(simulation, state).distance
    assert list(replay(recording))[-1].robots == state.robots


def test_a_recording_that_begins_in_the_middle_is_not_replayed() -> None:
    simulation = Simulation(random_world(1))
    recording = Recorder(simulation, step(simulation, start(simulation))).recording()
    with pytest.raises(RecordingError, match="begins in the middle of its run"):
        next(replay(recording))


def test_a_missing_file_and_a_file_of_another_kind_are_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"none\.npz: there is no such file"):
        load_recording(tmp_path / "none.npz")
    other = tmp_path / "other.npz"
    other.write_text("hello")
    with pytest.raises(RecordingError, match=r"other\.npz: not a recording, or a damaged one"):
        load_recording(other)
    np.savez(other, header=np.frombuffer(b'{"format": 99}', dtype=np.uint8))
    with pytest.raises(RecordingError, match="format 99 is not the format 1"):
        load_recording(other)


@pytest.mark.parametrize(
    ("field", "change"),
    [
        ("world", None),
        ("robots", []),
        ("robots", [{"name": "a"}]),
        ("seed", -1),
        ("tick", "soon"),
    ],
)
def test_a_recording_that_no_run_can_produce_is_refused(saved_path: Path, field: str, change: object) -> None:
    with np.load(saved_path) as file:
        arrays = dict(file)
    header = json.loads(arrays["header"].tobytes())
    description = json.loads(header["simulation"])
    description[field] = change
    header["simulation"] = json.dumps(description)
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(saved_path, **arrays)
    with pytest.raises(RecordingError, match="the description of the run is damaged"):
        load_recording(saved_path)


@pytest.mark.parametrize("column", ["poses", "times_ns", "scan0_ranges"])
def test_a_recording_whose_columns_do_not_match_is_refused(saved_path: Path, column: str) -> None:
    with np.load(saved_path) as file:
        arrays = dict(file)
    arrays[column] = arrays[column][:-1]
    np.savez(saved_path, **arrays)
    with pytest.raises(RecordingError, match=r"the column .* has the shape"):
        load_recording(saved_path)


@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(share=st.floats(0, 1), value=st.integers(0, 255), cut=st.booleans())
def test_a_damaged_file_is_a_recording_error_and_nothing_else(
    saved_path: Path, share: float, value: int, cut: bool
) -> None:
    data = bytearray(saved_path.read_bytes())
    offset = int(share * (len(data) - 1))
    if cut:
        del data[offset:]
    else:
        data[offset] = value
    damaged = saved_path.with_name("damaged.npz")
    damaged.write_bytes(data)
    try:
        rows = len(load_recording(damaged))
    except RecordingError as error:
        rows = 61 if "damaged.npz" in str(error) else 0
    assert rows == 61
