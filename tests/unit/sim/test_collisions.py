"""Contacts: no robot drives through a wall or into an obstacle, at any speed and with any shape."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim import BOX_NAMES, Command, Mover, Pose, RobotSpec, Simulation, State, World, box, clearance, start, step
from sim.engine import shapes
from sim.engine.index import layout
from sim.state import Event
from tests.unit.sim.worlds import ENGINES, random_pose, random_world, simulation_at

ROOM = World.from_segments(box(4.0, 3.0), segment_names=BOX_NAMES)
SQUARE = ((-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1))
FAST: dict[str, Any] = {
    "max_linear": 20.0,
    "max_angular": 20.0,
    "max_linear_acceleration": math.inf,
    "max_angular_acceleration": math.inf,
}


def drive(simulation: Simulation, command: Command, seconds: float, dt: float = 0.1) -> list[State]:
    states = [start(simulation)]
    for _ in range(round(seconds / dt)):
        states.append(step(simulation, states[-1], command, dt))
    return states


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("footprint", [None, SQUARE])
def test_a_robot_stops_at_a_wall_and_the_contact_is_recorded_once(engine: str, footprint: Any) -> None:
    subject = simulation_at(Pose(), ROOM, engine, footprint=footprint)
    states = drive(subject, Command(0.5, 0.0), 6.0)
    robot = states[-1].robots[0]
    reach = 0.15 if footprint else 0.105
    assert robot.pose.x == pytest.approx(2.0 - reach, abs=1e-5)
    assert robot.velocity.linear == 0.0
    assert robot.collided
    assert robot.collisions == 1
    (event,) = [event for state in states for event in state.events]
    assert (event.kind, event.what) == ("collision", "robot met east wall at 0.50 m/s")
    assert event.x == pytest.approx(2.0)
    assert event.time_ns == pytest.approx(3.9e9, abs=0.3e9)
    nearest = clearance(subject, states[-1])
    assert nearest.name == "east wall"
    assert 0.0 < nearest.distance < 1e-5


@pytest.mark.parametrize("engine", ENGINES)
def test_a_robot_can_turn_away_and_back_off_from_a_wall(engine: str) -> None:
    subject = simulation_at(Pose(1.8, 0.0), ROOM, engine)
    blocked = drive(subject, Command(0.5, 0.0), 1.0)[-1]
    turned = step(subject, blocked, Command(0.0, 1.0), 0.5)
    assert turned.robots[0].pose.theta == pytest.approx(0.5, abs=0.1)
    retreat = step(subject, blocked, Command(-0.5, 0.0), 0.4)
    assert retreat.robots[0].pose.x < 1.8
    assert not retreat.robots[0].collided


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("footprint", [None, SQUARE])
def test_a_sliding_robot_keeps_the_part_of_its_motion_along_the_wall(engine: str, footprint: Any) -> None:
    subject = simulation_at(Pose(0.0, 1.0, math.pi / 4), ROOM, engine, on_collision="slide", footprint=footprint)
    robot = drive(subject, Command(0.4, 0.0), 4.0)[-1].robots[0]
    assert robot.pose.x > 0.8
    assert robot.velocity.linear == 0.4
    corner = drive(replace(subject, engine="numba"), Command(0.4, 0.0), 20.0)[-1]
    assert clearance(subject, corner).distance > 0.0
    assert corner.robots[0].pose.x > 1.8


@settings(deadline=None, max_examples=40)
@given(
    seed=st.integers(0, 10**6),
    v=st.floats(-20, 20),
    w=st.floats(-20, 20),
    slide=st.booleans(),
    polygon=st.booleans(),
)
def test_no_robot_enters_or_jumps_a_wall_at_any_speed(
    seed: int, v: float, w: float, slide: bool, polygon: bool
) -> None:
    """At 20 m/s a tick is 0.4 m long, and a wall has no thickness. A test of the end points alone misses the wall."""
    random = np.random.default_rng(seed)
    world = random_world(seed, walls=12, size=5.0, pillars=2)
    spec = RobotSpec(**FAST, on_collision="slide" if slide else "stop", footprint=SQUARE if polygon else None)
    for _ in range(20):
        pose = random_pose(random, 4.6)
        subject = Simulation(world, (replace(spec, start=pose),), engine="numba")
        state = start(subject)
        if clearance(subject, state).distance > 1e-3:
            break
    else:
        return
    walls = world.segments
    for _ in range(12):
        before = state.robots[0].pose
        state = step(subject, state, Command(v, w))
        after = state.robots[0].pose
        assert clearance(subject, state).distance > 0.0
        assert max(abs(after.x), abs(after.y)) < 2.5
        if abs(w) * 0.02 * abs(v) < 0.05:  # nearly straight: the centre's way crosses no wall
            assert not any(crosses(before, after, wall) for wall in walls.tolist())


def crosses(a: Pose, b: Pose, wall: list[float]) -> bool:
    def is_left(px: float, py: float, qx: float, qy: float, x: float, y: float) -> bool:
        return (qx - px) * (y - py) - (qy - py) * (x - px) > 0

    x1, y1, x2, y2 = wall
    is_on_both_sides = is_left(x1, y1, x2, y2, a.x, a.y) != is_left(x1, y1, x2, y2, b.x, b.y)
    return is_on_both_sides and is_left(a.x, a.y, b.x, b.y, x1, y1) != is_left(a.x, a.y, b.x, b.y, x2, y2)


def test_a_robot_at_20_metres_a_second_does_not_jump_a_thin_wall() -> None:
    world = World.from_segments([[1.0, -1.0, 1.0, 1.0]])
    subject = simulation_at(Pose(), world, **FAST)
    state = step(subject, start(subject), Command(20.0, 0.0), 0.5)
    assert state.robots[0].pose.x == pytest.approx(1.0 - 0.105, abs=1e-5)


def test_robots_collide_with_each_other() -> None:
    robots = (RobotSpec(name="a", start=Pose(-0.5)), RobotSpec(name="b", start=Pose(0.5, 0.0, math.pi)))
    subject = Simulation(ROOM, robots)
    state, events = start(subject), list[Event]()
    for _ in range(20):
        state = step(subject, state, {"a": Command(0.5, 0.0), "b": Command(0.5, 0.0)}, 0.1)
        events += state.events
    distance = state.robots[1].pose.x - state.robots[0].pose.x
    assert distance == pytest.approx(0.21, abs=1e-4)
    assert distance > 0.21
    assert {event.what.split(" at ")[0] for event in events} == {"a met robot b", "b met robot a"}


@pytest.mark.parametrize("engine", ENGINES)
def test_a_mover_that_runs_into_a_robot_is_a_collision_and_the_robot_can_drive_away(engine: str) -> None:
    mover = Mover(((1.0, 0.0), (-1.0, 0.0)), radius=0.2, speed=0.5, phase=0.0, name="cart")
    world = World.from_segments(box(4.0, 3.0), movers=[mover])
    subject = simulation_at(Pose(), world, engine)
    states = drive(subject, Command(), 2.0)
    assert [event.what for state in states for event in state.events] == ["robot met cart at 0.00 m/s"]
    assert clearance(subject, states[-1]).distance < 0.0
    assert clearance(subject, states[-1]).name == "cart"
    collided = next(state for state in states if state.robots[0].collided)
    state_after = step(subject, collided, Command(-0.5, 0.0), 1.0)
    assert state_after.robots[0].pose.x < -0.2


def test_a_robot_that_starts_inside_a_wall_can_get_out() -> None:
    subject = simulation_at(Pose(1.95, 0.0), ROOM)
    assert clearance(subject, start(subject)).distance == pytest.approx(0.05 - 0.105)
    out = drive(subject, Command(-0.5, 0.0), 1.0)[-1]
    assert clearance(subject, out).distance > 0.0


def test_clearance_names_the_nearest_thing_and_where_it_is() -> None:
    world = World.from_segments(
        box(4.0, 3.0), circles=[[-1.0, 1.0, 0.25]], segment_names=BOX_NAMES, circle_names=("post",)
    )
    for pose, name, distance, point in (
        (Pose(0.0, 1.0), "north wall", 0.395, (0.0, 1.5)),
        (Pose(1.5, 0.0), "east wall", 0.395, (2.0, 0.0)),
        (Pose(-1.0, 0.5), "post", 0.145, (-1.0, 0.75)),
    ):
        subject = simulation_at(pose, world)
        nearest = clearance(subject, start(subject))
        assert nearest.name == name
        assert nearest.distance == pytest.approx(distance)
        assert (nearest.x, nearest.y) == pytest.approx(point)
    unnamed = simulation_at(Pose(0.0, 1.0), World.from_segments(box(4.0, 3.0)))
    assert clearance(unnamed, start(unnamed)).name == "wall 2"


@pytest.mark.slow
@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10**6))
def test_the_gap_of_a_polygon_is_the_distance_between_the_shapes(seed: int) -> None:
    """Against a thousand points along each of the two."""
    random = np.random.default_rng(seed)
    pose = random_pose(random, 2.0)
    wall = random.uniform(-1, 1, 4)
    body = np.array([(0.1, 0.2), *SQUARE])
    touch = np.empty(6)
    gap = shapes.gap(pose.x, pose.y, pose.theta, body, layout(wall[None]), np.empty((0, 3)), touch)
    c, s = math.cos(pose.theta), math.sin(pose.theta)
    t = np.linspace(0, 1, 1000)[:, None]
    corners = np.array(SQUARE)
    rim = np.concatenate([a + t * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)])
    line = wall[:2] + t * (wall[2:] - wall[:2])
    local = (line - [pose.x, pose.y]) @ np.array([[c, -s], [s, c]])
    inside = (np.abs(local) <= [0.15, 0.1]).all(axis=1).any()
    if inside:
        assert gap <= 0.0
    else:
        sampled = min(np.linalg.norm(rim - point, axis=1).min() for point in local[::4])
        assert -1e-6 <= sampled - gap <= 6e-3 or (gap <= 0.0 and sampled < 3e-3)
