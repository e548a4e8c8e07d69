"""The differential drive: exact arcs, limits, the watchdog, odometry, movers."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim import (
    Command,
    Goal,
    Mover,
    OdometryDrift,
    Pose,
    RobotSpec,
    Simulation,
    SpecError,
    State,
    World,
    WorldError,
    clearance,
    start,
    step,
)
from sim.engine.trig import HALF_PI_1, HALF_PI_2, HALF_PI_3, sinc, sincos, wrap
from tests.unit.sim.worlds import ENGINES

NOWHERE = World(name="nowhere")
FREE = RobotSpec(
    max_linear=10.0,
    max_angular=10.0,
    max_linear_acceleration=math.inf,
    max_angular_acceleration=math.inf,
    watchdog=math.inf,
)
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803")


def drive(spec: RobotSpec, command: Command, seconds: float, engine: str = "numpy", **settings: float) -> State:
    simulation = Simulation(NOWHERE, (spec,), engine=engine, **settings)  # type: ignore[arg-type]
    return step(simulation, start(simulation), command, seconds)


@given(st.floats(-1e4, 1e4))
def test_sine_and_cosine_are_within_a_rounding_error_of_the_library(angle: float) -> None:
    s, c = sincos(angle)
    assert abs(s - math.sin(angle)) <= 4e-16
    assert abs(c - math.cos(angle)) <= 4e-16


def test_the_parts_of_half_pi_add_up_to_it() -> None:
    error = Fraction(HALF_PI_1) + Fraction(HALF_PI_2) + Fraction(HALF_PI_3) - PI / 2
    assert abs(error) < Fraction(1, 10**36)


@given(st.floats(-20, 20))
def test_sinc_is_smooth_through_zero(x: float) -> None:
    assert sinc(x) == pytest.approx(math.sin(x) / x if x else 1.0, abs=1e-15)


@given(st.floats(-1000, 1000))
def test_headings_are_wrapped_into_one_turn(angle: float) -> None:
    wrapped = wrap(angle)
    assert -math.pi <= wrapped < math.pi
    assert math.cos(wrapped - angle) == pytest.approx(1.0)


@pytest.mark.parametrize("engine", ENGINES)
@settings(deadline=None)
@given(v=st.floats(-5, 5), w=st.floats(-5, 5), seconds=st.floats(0.02, 3))
def test_the_path_is_the_closed_form_of_an_arc(engine: str, v: float, w: float, seconds: float) -> None:
    pose = drive(replace(FREE, start=Pose(1.0, 2.0, 0.5)), Command(v, w), seconds, engine).robots[0].pose
    t = round(seconds * 1e9) / 1e9
    half = w * t / 2
    chord = v * t * (math.sin(half) / half) if half else v * t
    end = (1.0 + chord * math.cos(0.5 + half), 2.0 + chord * math.sin(0.5 + half))
    assert (pose.x, pose.y) == pytest.approx(end, abs=1e-11, rel=0)
    assert math.cos(pose.theta - (0.5 + w * t)) == pytest.approx(1.0)


def test_a_full_circle_ends_where_it_started() -> None:
    pose = drive(FREE, Command(0.5, math.tau / 10), 10.0).robots[0].pose
    assert (pose.x, pose.y, pose.theta) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_speeds_and_accelerations_keep_within_their_limits() -> None:
    spec = RobotSpec(max_linear=0.5, max_angular=1.0, max_linear_acceleration=1.0, max_angular_acceleration=5.0)
    simulation = Simulation(NOWHERE, (spec,))
    state, speeds = start(simulation), [(0.0, 0.0)]
    for _ in range(50):
        state = step(simulation, state, Command(9.0, -9.0))
        speeds.append((state.robots[0].velocity.linear, state.robots[0].velocity.angular))
    v, w = np.array(speeds).T
    assert v.max() == 0.5
    assert w.min() == -1.0
    assert np.diff(v).max() == pytest.approx(0.02)
    assert np.diff(w).min() == pytest.approx(-0.1)
    assert v[25] == pytest.approx(0.5)
    assert v[24] < 0.49


@pytest.mark.parametrize("engine", ENGINES)
def test_the_watchdog_stops_a_robot_without_commands(engine: str) -> None:
    spec = replace(FREE, watchdog=0.3)
    simulation = Simulation(NOWHERE, (spec,), engine=engine)  # type: ignore[arg-type]
    state = step(simulation, start(simulation), Command(1.0, 0.0))
    for _ in range(14):
        state = step(simulation, state)
    assert state.robots[0].velocity.linear == 1.0
    state = step(simulation, state)
    assert state.robots[0].velocity.linear == 0.0
    assert state.robots[0].pose.x == pytest.approx(0.3)
    (event,) = state.events
    assert (event.kind, event.what) == ("watchdog", "robot had no new command for 0.3 s and stops")
    assert event.time_ns == 300_000_000
    assert step(simulation, state).events == ()
    moving = step(simulation, state, Command(1.0, 0.0))
    assert moving.robots[0].velocity.linear == 1.0


def test_simulated_time_is_counted_in_whole_nanoseconds() -> None:
    simulation = Simulation(NOWHERE, (FREE,), tick=1 / 30)
    state = start(simulation)
    for _ in range(90):
        state = step(simulation, state)
    assert (state.time_ns, state.tick) == (90 * 33_333_333, 90)
    assert step(simulation, state, dt=0.05).time_ns == state.time_ns + 50_000_000


def test_odometry_of_perfect_wheels_equals_the_true_pose() -> None:
    simulation = Simulation(NOWHERE, (replace(FREE, start=Pose(2.0, 1.0, 1.0)),))
    state = start(simulation)
    for command in (Command(0.5, 0.3), Command(-0.2, 1.0), Command(0.7, 0.0)):
        state = step(simulation, state, command, 1.0)
    robot = state.robots[0]
    s, c = math.sin(1.0), math.cos(1.0)
    x, y = robot.odometry.x, robot.odometry.y
    assert (2.0 + c * x - s * y, 1.0 + s * x + c * y) == pytest.approx((robot.pose.x, robot.pose.y))
    assert wrap(robot.odometry.theta + 1.0 - robot.pose.theta) == pytest.approx(0.0, abs=1e-12)
    assert robot.covariance == (0.0,) * 9


@pytest.mark.parametrize("command", [Command(0.5, 0.0), Command(0.4, 0.5), Command(0.0, 1.0)])
def test_the_covariance_of_odometry_fits_its_errors(command: Command) -> None:
    """The sample covariance of many robots' errors is close to the covariance that they report."""
    drift = OdometryDrift(linear=0.03, angular=0.03, veer=0.02)
    spec = replace(FREE, drift=drift)
    perfect = drive(FREE, command, 4.0, "numba").robots[0].odometry
    errors, reported = [], []
    for seed in range(400):
        simulation = Simulation(NOWHERE, (spec,), seed=seed, engine="numba")
        robot = step(simulation, start(simulation), command, 4.0).robots[0]
        odometry = robot.odometry
        errors.append((odometry.x - perfect.x, odometry.y - perfect.y, wrap(odometry.theta - perfect.theta)))
        reported.append(np.reshape(robot.covariance, (3, 3)))
    covariance = np.mean(reported, axis=0)
    np.testing.assert_array_equal(covariance, covariance.T)
    assert np.linalg.eigvalsh(covariance).min() >= -1e-15
    sample = np.cov(np.array(errors).T)
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-18))
    np.testing.assert_allclose(sample / np.outer(scale, scale), covariance / np.outer(scale, scale), atol=0.25)
    assert np.abs(np.mean(errors, axis=0) / scale).max() < 0.25


def test_a_mover_walks_there_and_back_and_rests_at_each_point() -> None:
    mover = Mover(((0.0, 0.0), (2.0, 0.0)), speed=1.0, pause=1.0, phase=0.0)
    simulation = Simulation(World.from_segments([], movers=[mover]))
    positions = [simulation.movers_at(round(t * 1e9))[0][0] for t in (0, 1, 2, 2.5, 3, 4, 5, 5.9, 6, 7)]
    assert positions == pytest.approx([0, 1, 2, 2, 2, 1, 0, 0, 0, 1])


def test_a_mover_goes_round_a_loop() -> None:
    mover = Mover(((0, 0), (1, 0), (1, 1)), speed=1.0, loop=True, phase=0.0)
    simulation = Simulation(World.from_segments([], movers=[mover]))
    half = 2.0 + math.sqrt(0.5)
    assert simulation.movers_at(round(half * 1e9))[0][:2] == pytest.approx((0.5, 0.5))


def test_the_seed_decides_where_a_mover_starts() -> None:
    world = World.from_segments([], movers=[Mover(((0, 0), (4, 0))), Mover(((0, 1), (4, 1)))])
    first_positions = [tuple(x for x, _, _ in Simulation(world, seed=seed).movers_at(0)) for seed in (1, 1, 2)]
    assert first_positions[0] == first_positions[1] != first_positions[2]
    assert first_positions[0][0] != first_positions[0][1]


def test_a_mover_with_one_point_does_not_move() -> None:
    simulation = Simulation(World.from_segments([], movers=[Mover(((1.0, 2.0),))]))
    assert simulation.movers_at(10**12) == [(1.0, 2.0, 0.2)]


def test_an_empty_world_has_no_nearest_obstacle() -> None:
    simulation = Simulation(NOWHERE)
    nearest = clearance(simulation, start(simulation))
    assert (nearest.distance, nearest.name) == (math.inf, "nothing")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": ""}, "name is ''; give a short text"),
        ({"radius": 0.0}, "radius is 0.0; give metres"),
        ({"max_linear": math.nan}, "max_linear is nan; give m/s"),
        ({"max_angular": -1.0}, "max_angular is -1.0; give rad/s"),
        ({"max_linear_acceleration": 0.0}, "max_linear_acceleration is 0.0"),
        ({"max_angular_acceleration": -2.0}, "max_angular_acceleration is -2.0"),
        ({"watchdog": 0.0}, "watchdog is 0.0; give seconds"),
        ({"on_collision": "bounce"}, "on_collision is 'bounce'; give 'stop' or 'slide'"),
        ({"start": Pose(math.inf, 0.0, 0.0)}, "give a pose of finite numbers"),
        ({"footprint": ((0, 0), (1, 0))}, "give three points or more of a convex polygon"),
        ({"footprint": ((-1, -1), (-1, 1), (1, 1), (1, -1))}, "anticlockwise"),
        ({"footprint": ((-1, -1), (1, -1), (0.2, 0), (1, 1), (-1, 1))}, "convex"),
        ({"footprint": ((2, 2), (3, 2), (3, 3))}, "round \\(0, 0\\)"),
    ],
)
def test_an_invalid_robot_is_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(SpecError, match=message):
        replace(RobotSpec(), **change)  # type: ignore[arg-type]


def test_an_invalid_drift_is_refused() -> None:
    with pytest.raises(SpecError, match="drift: veer is -1; give a standard deviation"):
        OdometryDrift(veer=-1)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"robots": ()}, "a simulation needs a robot"),
        ({"robots": (RobotSpec(), RobotSpec())}, "two robots have the same name"),
        ({"tick": 0.0}, "tick is 0.0 s; give the physics period"),
        ({"seed": -1}, "seed is -1; give a whole number"),
        ({"seed": 0.5}, "seed is 0.5; give a whole number"),
    ],
)
def test_an_invalid_simulation_is_refused(settings: dict[str, object], message: str) -> None:
    with pytest.raises(SpecError, match=message):
        Simulation(NOWHERE, **settings)  # type: ignore[arg-type]


@pytest.mark.parametrize("dt", [0.0, -1.0, math.nan, math.inf, 1e9])
def test_an_invalid_step_is_refused(dt: float) -> None:
    simulation = Simulation(NOWHERE)
    with pytest.raises(SpecError, match="give a step in seconds, above 0"):
        step(simulation, start(simulation), Command(), dt)


def test_invalid_commands_are_refused() -> None:
    unnamed_robot = Simulation(NOWHERE)
    named_robots = Simulation(NOWHERE, (RobotSpec(name="a"), RobotSpec(name="b")))
    with pytest.raises(SpecError, match="the command for robot 'robot' is not finite"):
        step(unnamed_robot, start(unnamed_robot), Command(math.nan, 0.0))
    with pytest.raises(SpecError, match="one command for several robots"):
        step(named_robots, start(named_robots), Command())
    with pytest.raises(SpecError, match="there is no robot 'c'; the robots are: a, b"):
        step(named_robots, start(named_robots), {"c": Command()})


def test_invalid_worlds_are_refused() -> None:
    for build, message in (
        (lambda: World.from_segments([[0, 0, 1, math.nan]]), "segments contain a number that is not within"),
        (lambda: World.from_segments([[0, 0, 1, 1e9]]), "segments contain a number that is not within"),
        (lambda: World(segments=np.zeros((2, 3))), r"segments have the shape \(2, 3\)"),
        (lambda: World(segments=["a"]), "segments are not numbers"),  # type: ignore[arg-type]
        (lambda: World(circles=np.zeros((1, 3))), "radius is not above zero"),
        (lambda: World.from_segments([[0, 0, 1, 1]], segment_names=("a", "b")), "contains 2 names for 1"),
        (lambda: World.from_segments([], starts=[Pose(math.nan)]), "a start pose is not within the world"),
        (lambda: Goal(0.0, math.inf), "a goal at"),
        (lambda: Mover(()), "the path of the mover"),
        (lambda: Mover(((0, 0),), speed=0.0), "the speed of the mover"),
        (lambda: Mover(((0, 0),), phase=2.0), "the phase of the mover"),
    ):
        with pytest.raises(WorldError, match=message):
            build()
