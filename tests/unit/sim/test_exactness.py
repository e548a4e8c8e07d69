"""The lidar against brute force in extended and in rational arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from sim import LidarSpec, Pose, World, cast, directions
from tests.unit.sim.oracle import extended, rational, rational_disc
from tests.unit.sim.worlds import ENGINES, FULL_TURN, random_pose, random_world, simulation_at

TOLERANCE = 1e-12
numbers = st.floats(-8, 8).map(lambda value: value if abs(value) >= 1e-50 else 0.0)
angles = st.floats(-3.2, 3.2).map(lambda value: value if abs(value) >= 1e-50 else 0.0)
small = st.integers(-4, 4).map(float)
points = st.tuples(small, small) | st.tuples(numbers, numbers)
walls = st.lists(st.tuples(points, points).map(lambda ends: (*ends[0], *ends[1])), min_size=1, max_size=6)


def largest_error(scans: int, seed: int, engine: str) -> float:
    """Cast scans in random worlds, assert that hits and misses agree, and return the largest error."""
    random = np.random.default_rng(seed)
    largest = 0.0
    for number in range(scans):
        if number % 100 == 0:
            world = random_world(int(random.integers(1 << 30)), walls=20)
            simulation = simulation_at(Pose(), world, engine)
        pose = random_pose(random)
        ranges = cast(simulation, pose, FULL_TURN)
        expected = extended((pose.x, pose.y), directions(pose, FULL_TURN), world.segments, world.circles)
        expected[expected > FULL_TURN.range_max] = np.inf
        hits = np.isfinite(expected)
        np.testing.assert_array_equal(np.isfinite(ranges), hits)
        largest = max(largest, float(np.abs(ranges[hits] - expected[hits]).max(initial=0.0)))
    return largest


@pytest.mark.parametrize("engine", ENGINES)
def test_a_sample_of_beams_agrees_with_extended_precision(engine: str) -> None:
    assert largest_error(60, 1, engine) <= TOLERANCE


@pytest.mark.nightly
def test_a_million_beams_agree_with_extended_precision() -> None:
    assert largest_error(2800, 2, "numba") <= TOLERANCE


def check_fan(origin: tuple[float, float], yaw: float, segments: list[tuple[float, float, float, float]]) -> None:
    """Compare a fan of beams with rational arithmetic in both engines."""
    world = World.from_segments(segments)
    lidar = LidarSpec(beams=8, angle_increment=math.tau / 8, range_min=0.0, range_max=50.0)
    pose = Pose(*origin, yaw)
    beam_directions = directions(pose, lidar)
    expected = [rational(origin, (float(x), float(y)), world.segments.tolist()) for x, y in beam_directions]
    for engine in ENGINES:
        ranges = cast(simulation_at(pose, world, engine), pose, lidar)
        for beam, (measured, exact) in enumerate(zip(ranges.tolist(), expected, strict=True)):
            if exact is None or exact > 50:
                assert measured == math.inf, (
                    f"{engine}: beam {beam} meets something at {measured}, and nothing is there"
                )
            else:
                assert measured < math.inf, f"{engine}: beam {beam} misses what is at {float(exact)}"
                assert abs(Fraction(measured) - exact) <= TOLERANCE


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(points, angles, walls)
@example((0.0, 0.0), 0.0, [(1.0, 0.0, 3.0, 0.0)])  # along a wall
@example((2.0, 0.0), 0.3, [(1.0, 0.0, 3.0, 0.0)])  # on a wall
@example((1.0, 0.0), 0.3, [(1.0, 0.0, 3.0, 0.0)])  # on a wall's end
@example((0.0, 0.0), 0.0, [(1.0, 1.0, 2.0, 2.0), (2.0, 0.0, 2.0, 0.0)])  # a wall of no length
@example((0.0, 0.0), 0.0, [(2.0, 0.0, 2.0, 2.0), (2.0, -2.0, 2.0, 0.0)])  # through a shared end
@example((0.0, 0.0), 0.0, [(-2.0, -2.0, 2.0, -2.0), (2.0, -2.0, 2.0, 2.0)])  # at a corner
def test_beams_hit_walls_where_rational_arithmetic_says(
    origin: tuple[float, float], yaw: float, segments: list[tuple[float, float, float, float]]
) -> None:
    check_fan(origin, yaw, segments)


@settings(deadline=None, max_examples=150)
@given(points, angles, st.floats(0.01, 20), st.integers(-3, 3), st.floats(0.01, 20), st.integers(-3, 3))
def test_walls_that_a_beam_touches_or_runs_along_are_decided_exactly(
    origin: tuple[float, float], yaw: float, near: float, left: int, far: float, right: int
) -> None:
    """The wall's ends are on the beam, or up to three rounding errors beside it."""
    x, y = directions(Pose(*origin, yaw), LidarSpec(beams=1))[0].tolist()

    def beside(distance: float, steps: int) -> tuple[float, float]:
        px, py = origin[0] + distance * x, origin[1] + distance * y
        for _ in range(abs(steps)):
            py = math.nextafter(py, math.copysign(math.inf, steps))
        return px, py

    check_fan(origin, yaw, [(*beside(near, left), *beside(far, right))])


@pytest.mark.slow
@settings(deadline=None, max_examples=100)
@given(st.lists(points, min_size=3, max_size=7, unique=True), points)
def test_no_beam_slips_through_a_closed_outline_at_its_corners(
    corners: list[tuple[float, float]], origin: tuple[float, float]
) -> None:
    """Aim each beam at a shared corner: it must meet one of the two walls there, or something before it."""
    outline = [(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    world = World.from_segments(outline)
    for x, y in corners:
        distance = math.hypot(x - origin[0], y - origin[1])
        assume(distance > 1e-3)
        yaw = math.atan2(y - origin[1], x - origin[0])
        lidar = LidarSpec(beams=1, range_min=0.0, range_max=100.0)
        expected = rational(origin, tuple(directions(Pose(*origin, yaw), lidar)[0].tolist()), world.segments.tolist())
        for engine in ENGINES:
            measured = cast(simulation_at(Pose(*origin, yaw), world, engine), Pose(*origin, yaw), lidar)[0]
            assert (measured < math.inf) == (expected is not None)


@settings(deadline=None, max_examples=200)
@given(angles, st.floats(1, 20), st.floats(0.05, 0.9), st.sampled_from((0.0, 1e-16, 1e-15, 1e-13, 1e-10, 1e-7, 1e-4)))
def test_a_beam_nearly_tangent_to_a_pillar_is_measured_to_a_picometre(
    yaw: float, distance: float, radius: float, inside: float
) -> None:
    lidar = LidarSpec(beams=1, range_min=0.0, range_max=30.0)
    pose = Pose(0.3, -0.7, yaw)
    x, y = directions(pose, lidar)[0].tolist()
    gap = radius - inside
    circle = (pose.x + distance * x - gap * y, pose.y + distance * y + gap * x, radius)
    expected = rational_disc((pose.x, pose.y), (x, y), circle)
    for engine in ENGINES:
        measured = cast(simulation_at(pose, World.from_segments([], circles=[circle]), engine), pose, lidar)[0]
        assert measured == math.inf if expected is None else abs(measured - expected) <= TOLERANCE


@pytest.mark.parametrize("engine", ENGINES)
def test_a_robot_inside_a_wall_or_a_pillar_measures_only_ranges_near_zero(engine: str) -> None:
    for world in (
        World.from_segments([[-1.0, 0.0, 1.0, 0.0]]),
        World.from_segments([], circles=[[0.1, 0.1, 0.5]]),
    ):
        assert (cast(simulation_at(Pose(), world, engine), Pose(), FULL_TURN) <= 1e-300).all()
