"""The scan: its fields, REP 117, noise, faults, skew, mounting, other robots."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim import (
    LDS_01,
    RPLIDAR_A1,
    UTM_30LX,
    Command,
    DeadSector,
    Faults,
    LidarSpec,
    Mover,
    Pose,
    RobotSpec,
    Scan,
    Simulation,
    SpecError,
    State,
    Window,
    World,
    box,
    observe,
    scan_angles,
    start,
    step,
)
from tests.unit.sim.worlds import ENGINES, random_world, simulation_at

ROOM = World.from_segments(box(4.0, 3.0))


def scan_of(simulation: Simulation, state: State | None = None, robot: str | None = None) -> Scan:
    scan = observe(simulation, state or start(simulation), robot)
    assert scan is not None
    return scan


@pytest.mark.parametrize("lidar", [LDS_01, RPLIDAR_A1, UTM_30LX])
def test_a_preset_fills_every_field_of_a_laserscan(lidar: LidarSpec) -> None:
    scan = scan_of(simulation_at(Pose(), ROOM, lidar=lidar))
    assert scan.frame_id == "laser"
    assert scan.stamp_ns == 0
    assert scan.ranges.dtype == scan.intensities.dtype == np.float32
    assert len(scan.ranges) == lidar.beams
    assert scan.angle_max == scan.angle_min + (lidar.beams - 1) * scan.angle_increment
    assert (scan.range_min, scan.range_max) == (lidar.range_min, lidar.range_max)
    assert scan.scan_time == 1.0 / lidar.rate
    assert scan.time_increment == 0.0
    assert not scan.ranges.flags.writeable
    with pytest.raises(AttributeError):
        scan.stamp_ns = 1  # type: ignore[misc]


def test_the_lds_01_starts_straight_ahead_and_never_doubles_a_beam() -> None:
    scan = scan_of(simulation_at(Pose(), ROOM, lidar=LDS_01))
    assert scan.ranges[0] == 2.0  # 2 m to the east wall
    assert scan.ranges[90] == 1.5
    assert (LDS_01.beams, LDS_01.angle_min) == (360, 0.0)
    assert LDS_01.angle_max < math.tau - 0.9 * LDS_01.angle_increment


def test_the_utm_30lx_covers_270_degrees_with_1081_beams_and_looks_ahead_in_the_middle() -> None:
    scan = scan_of(simulation_at(Pose(), ROOM, lidar=UTM_30LX))
    assert math.isclose(scan.angle_max - scan.angle_min, math.radians(270))
    assert scan_angles(scan)[540] == pytest.approx(0.0, abs=1e-12)
    assert scan.ranges[540] == 2.0


@pytest.mark.parametrize("engine", ENGINES)
def test_ranges_follow_rep_117(engine: str) -> None:
    lidar = LidarSpec(beams=4, angle_increment=math.tau / 4, range_min=0.5, range_max=3.0)
    world = World.from_segments(
        [[0.2, -1.0, 0.2, 1.0], [-1.0, 1.0, 1.0, 1.0], [-9.0, -1.0, -9.0, 1.0], [-1.0, -3.0, 1.0, -3.0]]
    )
    ranges = scan_of(simulation_at(Pose(), world, engine, lidar)).ranges
    assert ranges[0] == -np.inf  # 0.2 m ahead: too close to measure
    assert ranges[1] == 1.0
    assert ranges[2] == np.inf  # 9 m behind: no return
    assert ranges[3] == 3.0  # at range_max itself: a return


def test_a_lost_beam_is_nan_and_returns_nothing() -> None:
    scan = scan_of(simulation_at(Pose(), ROOM, lidar=replace(LDS_01, dropout=0.3)))
    is_lost = np.isnan(scan.ranges)
    assert 60 < is_lost.sum() < 160
    assert (scan.intensities[is_lost] == 0.0).all()


def test_intensities_fall_with_the_distance_and_are_empty_where_the_lidar_has_none() -> None:
    scan = scan_of(simulation_at(Pose(), World.from_segments(box(4.0, 30.0)), lidar=LDS_01))
    assert scan.intensities[0] == np.float32(1000 / (1 + 2.0**2))
    assert scan.intensities[90] == 0.0  # no return
    assert len(scan_of(simulation_at(Pose(), ROOM, lidar=replace(LDS_01, intensities=False))).intensities) == 0


def test_noise_is_gaussian_of_the_given_size_and_new_at_each_tick() -> None:
    lidar = replace(UTM_30LX, noise=0.03)
    noisy, exact = simulation_at(Pose(), ROOM, lidar=lidar), simulation_at(Pose(), ROOM, lidar=UTM_30LX)
    state = start(noisy)
    truth = scan_of(exact).ranges.astype(float)
    errors = []
    for _ in range(20):
        errors.append(scan_of(noisy, state).ranges - truth)
        state = step(noisy, state)
    flat = np.concatenate(errors)
    assert abs(flat.mean()) < 4 * 0.03 / math.sqrt(len(flat))
    assert flat.std() == pytest.approx(0.03, rel=0.03)
    assert abs(np.corrcoef(errors[0], errors[1])[0, 1]) < 0.15


def test_noise_depends_on_seed_and_robot() -> None:
    lidar = replace(LDS_01, noise=0.01)
    robots = (RobotSpec(name="a", lidar=lidar), RobotSpec(name="b", lidar=lidar, start=Pose(1.0, 0.5)))
    first, second = (Simulation(ROOM, robots, seed=seed) for seed in (1, 2))
    noise = [
        scan_of(subject, robot=name).ranges - scan_of(simulation_at(pose, ROOM, lidar=LDS_01)).ranges
        for subject in (first, second)
        for name, pose in (("a", Pose()),)
    ]
    assert not np.array_equal(noise[0], noise[1])
    single = Simulation(ROOM, (replace(robots[1], start=Pose()),), seed=1)
    assert not np.array_equal(scan_of(single).ranges, scan_of(Simulation(ROOM, robots[:1], seed=1)).ranges)


def test_a_lidar_is_mounted_at_its_own_frame() -> None:
    mount = Pose(0.5, 0.25, math.pi / 2)
    scan = scan_of(simulation_at(Pose(0.0, 0.0, math.pi / 2), ROOM, lidar=replace(LDS_01, mount=mount)))
    # the robot looks north: its lidar is 0.25 m west and 0.5 m north of it, and looks west
    assert scan.ranges[0] == pytest.approx(2.0 - 0.25)
    assert scan.ranges[270] == pytest.approx(1.5 - 0.5)


def test_lidars_see_the_other_robots_and_the_movers() -> None:
    world = World.from_segments(box(8, 8), movers=[Mover(((0.0, 2.0),), radius=0.5)])
    square = ((-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2))
    robots = (
        RobotSpec(name="a", start=Pose()),
        RobotSpec(name="b", start=Pose(1.5, 0.0), radius=0.25),
        RobotSpec(name="c", start=Pose(-1.5, 0.0), footprint=square),
    )
    ranges = scan_of(Simulation(world, robots), robot="a").ranges
    assert ranges[0] == 1.25
    assert ranges[90] == 1.5
    assert ranges[180] == pytest.approx(1.3)
    assert ranges[270] == np.inf


def test_a_failed_lidar_sends_no_scan() -> None:
    subject = simulation_at(Pose(), ROOM, faults=Faults(dead=(Window(0.1, 0.2),)))
    state = start(subject)
    scans_sent = []
    for _ in range(5):
        scans_sent.append(observe(subject, state) is not None)
        state = step(subject, state, dt=0.06)
    assert scans_sent == [True, True, False, False, True]


def test_a_frozen_lidar_repeats_one_scan_with_new_stamps() -> None:
    subject = simulation_at(
        Pose(), random_world(1, movers=2), lidar=replace(LDS_01, noise=0.01), faults=Faults(frozen=(Window(0.1, 0.3),))
    )
    states = [start(subject)]
    for _ in range(4):
        states.append(step(subject, states[-1], Command(0.3, 0.4), 0.1))
    scans = [scan_of(subject, state) for state in states]
    np.testing.assert_array_equal(scans[1].ranges, scans[2].ranges)
    assert [scan.stamp_ns for scan in scans] == [0, 100_000_000, 200_000_000, 300_000_000, 400_000_000]
    assert not np.array_equal(scans[0].ranges, scans[1].ranges)
    assert not np.array_equal(scans[2].ranges, scans[3].ranges)


def test_a_failed_sector_gives_nan_also_across_angle_zero() -> None:
    sector = DeadSector(math.radians(-10.5), math.radians(20.5), Window(0.0, 1.0))
    subject = simulation_at(Pose(), ROOM, lidar=LDS_01, faults=Faults(sectors=(sector,)))
    lost_beams = np.flatnonzero(np.isnan(scan_of(subject).ranges)).tolist()
    assert lost_beams == [*range(21), *range(350, 360)]
    later = step(subject, start(subject), dt=1.0)
    assert not np.isnan(scan_of(subject, later).ranges).any()
    all_round = DeadSector(0.0, math.tau)
    assert np.isnan(scan_of(simulation_at(Pose(), ROOM, faults=Faults(sectors=(all_round,)))).ranges).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_skewed_scan_takes_each_beam_from_where_the_robot_was(engine: str) -> None:
    """At 0.5 m/s and 5 scans a second, the first beam is measured almost 0.1 m before the last one."""
    lidar = replace(LDS_01, skew=True)
    subject = simulation_at(Pose(0.5, 0.0), World.from_segments(box(6.0, 4.0)), engine, lidar)
    state = step(subject, start(subject), Command(0.5, 0.0), 0.4)
    scan = scan_of(subject, state)
    sweep = 359 * scan.time_increment
    assert scan.time_increment == pytest.approx(0.2 / 360)
    assert state.time_ns - scan.stamp_ns == pytest.approx(sweep * 1e9, abs=10)
    assert scan.ranges[0] == pytest.approx(3.0 - state.robots[0].pose.x + 0.5 * sweep, abs=1e-6)
    still = simulation_at(state.robots[0].pose, subject.world, engine, LDS_01)
    assert scan.ranges[359] == scan_of(still).ranges[359]


@pytest.mark.parametrize("lidar", [LDS_01, RPLIDAR_A1, UTM_30LX], ids=lambda lidar: f"{lidar.beams} beams")
def test_no_beam_of_a_skewed_scan_is_later_than_the_newest_transform(lidar: LidarSpec) -> None:
    """tf2 does not extrapolate, and a LaserScan has the time increment as float32."""
    subject = simulation_at(Pose(), ROOM, lidar=replace(lidar, skew=True))
    state = step(subject, start(subject), dt=0.4)
    scan = scan_of(subject, state)
    last_beam_ns = scan.stamp_ns + (lidar.beams - 1) * float(np.float32(scan.time_increment)) * 1e9
    assert state.time_ns - 1 < last_beam_ns <= state.time_ns


def test_a_skewed_scan_is_the_same_from_both_engines_while_turning() -> None:
    bits = set()
    for engine in ENGINES:
        subject = simulation_at(Pose(), random_world(4), engine, replace(LDS_01, skew=True))
        state = step(subject, start(subject), Command(0.4, 1.5), 0.5)
        bits.add(scan_of(subject, state).ranges.tobytes())
    assert len(bits) == 1


@given(st.integers(0, 359))
def test_scan_angles_put_zero_ahead_and_left_positive(beam: int) -> None:
    angle = scan_angles(scan_of(simulation_at(Pose(), ROOM, lidar=LDS_01)))[beam]
    assert -math.pi <= angle < math.pi
    assert math.isclose(math.cos(angle), math.cos(math.radians(beam)), abs_tol=1e-9)
    assert math.isclose(math.sin(angle), math.sin(math.radians(beam)), abs_tol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"beams": 0}, "beams is 0; give from 1 to"),
        ({"beams": 361}, "cover more than a turn"),
        ({"angle_increment": 0.0}, "angle_increment is 0.0; give radians"),
        ({"angle_min": math.nan}, "angle_min is nan; give an angle"),
        ({"range_max": math.inf}, "range_max is inf; give metres"),
        ({"range_min": 9.0}, "range_min is 9.0; give metres, from 0 to below range_max"),
        ({"rate": 0.0}, "rate is 0.0; give scans a second"),
        ({"noise": -1.0}, "noise is -1.0; give a standard deviation"),
        ({"mount": Pose(math.inf)}, r"mount is .*; give a finite pose"),
        ({"dropout": 1.5}, "dropout is 1.5; give a probability"),
    ],
)
def test_an_invalid_lidar_is_refused(change: dict[str, float], message: str) -> None:
    with pytest.raises(SpecError, match=message):
        replace(LDS_01, **change)  # type: ignore[arg-type]


def test_invalid_faults_are_refused() -> None:
    with pytest.raises(SpecError, match="give a start of 0 or more and a later end"):
        Window(2.0, 1.0)
    with pytest.raises(SpecError, match="give two finite angles in radians"):
        DeadSector(math.nan, 1.0)


def test_a_robot_without_a_lidar_and_an_unknown_robot_are_named() -> None:
    subject = Simulation(ROOM, (RobotSpec(name="bob", lidar=None),))
    with pytest.raises(SpecError, match="robot 'bob' has no lidar"):
        observe(subject, start(subject))
    with pytest.raises(SpecError, match="there is no robot 'eve'; the robots are: bob"):
        observe(subject, start(subject), "eve")
