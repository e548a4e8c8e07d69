"""Every hidden input is within the bounds of its chapter's contract, whatever the seed."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from autograder.checks.ch02_nodes.hidden import world_generation
from autograder.checks.ch02_nodes.hidden.reaction import COARSE, EDGE, FINE, NEAR
from autograder.checks.ch02_nodes.hidden.readings import BESIDE, OTHER_LIMITS
from autograder.checks.ch02_nodes.hidden.worlds import MIN_PATH, RADIUS
from autograder.checks.ch02_nodes.support import contract as nodes
from autograder.checks.ch02_nodes.support.scans import JUST_AHEAD, RANGE_MAX, RANGE_MIN, Part, scan
from autograder.checks.ch04_launch.hidden.inputs import draw_inputs
from autograder.checks.ch04_launch.support import contract as launches
from sim import Command, RobotSpec, Scan, Simulation, World, clearance, observe, start, step

SEEDS = range(1000)
SELF_TEST = 20.0  # percent that the self-test needs


WORLDS = {
    "room": world_generation.furnished_room,
    "pillars": world_generation.hall_of_pillars,
    "corridor": world_generation.bent_corridor,
}


@pytest.mark.parametrize("name", WORLDS)
def test_each_world_has_room_around_its_start(name: str) -> None:
    for seed in SEEDS:
        world = WORLDS[name](random.Random(f"{seed}:test_{name}"))
        assert len(world.starts) == 1
        simulation = Simulation(world, (RobotSpec(radius=RADIUS),))
        assert clearance(simulation, start(simulation)).distance > RADIUS


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", WORLDS)
def test_a_robot_that_keeps_to_the_rule_drives_far_enough_and_touches_nothing(name: str, seed: int) -> None:
    draw = random.Random(f"{seed}:test_{name}")
    gap, path = _drive(WORLDS[name](draw), draw.randrange(2**31))
    assert gap > 0.01
    assert path >= MIN_PATH


def test_a_near_obstacle_is_measurable_and_within_the_sector_for_every_limit() -> None:
    assert all(RANGE_MIN < near < 0.2 for near in (*NEAR, JUST_AHEAD.value))
    assert all(0.0 < bearing < nodes.HALF_SECTOR - 6.0 for bearing in BESIDE)
    for (low, high), other_distance, (valid, phantom) in OTHER_LIMITS:
        assert low <= valid <= high <= RANGE_MAX
        assert not low <= phantom <= high
        assert other_distance > nodes.SAFETY_DISTANCE
        assert all(float(np.float32(value)) == value for value in (valid, phantom))


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(("lidar", "count"), [(COARSE, 1), (FINE, 3)])
def test_an_obstacle_beside_the_sector_s_edge_is_hit_by_enough_beams(
    side: float, lidar: tuple[int, float], count: int
) -> None:
    beams, wide = lidar
    for off in (-EDGE, EDGE):
        bearing = side * (nodes.HALF_SECTOR + off)
        assert abs(abs(bearing) - nodes.HALF_SECTOR) > wide
        message = scan(Part(bearing - wide, bearing + wide, 0.5), beams=beams)
        assert sum(reading == 0.5 for reading in message.ranges) == count
    assert nodes.HALF_SECTOR - EDGE - FINE[1] > math.degrees(0.5)  # half a radian is not 30 degrees


def test_launch_inputs_differ_from_every_default() -> None:
    for seed in SEEDS:
        inputs = draw_inputs(random.Random(f"{seed}:launch"))
        assert inputs.speed > 0.0
        assert inputs.speed != launches.SPEED
        assert inputs.low_battery < SELF_TEST < min(inputs.sufficient_battery, inputs.whole_battery) <= 100.0
        assert inputs.sufficient_battery != int(inputs.sufficient_battery)
        assert not {*inputs.names} & {launches.FIRST, launches.SECOND}
        assert {"'", '"'} < set(inputs.quoted_name)


def _drive(world: World, seed: int) -> tuple[float, float]:
    """Drive for a minute by the rule; return the smallest gap and the length of the path, in m."""
    simulation = Simulation(world, (RobotSpec(radius=RADIUS),), seed=seed)
    state, gap, path = start(simulation), math.inf, 0.0
    for _ in range(600):
        before = state.robots[0].pose
        command = _rule(observe(simulation, state))
        for _ in range(5):
            state = step(simulation, state, command, dt=0.02)
        after = state.robots[0].pose
        path += math.dist((before.x, before.y), (after.x, after.y))
        gap = min(gap, clearance(simulation, state).distance)
    return gap, path


def _rule(scan: Scan | None) -> Command:
    """Return the contract's command for a scan."""
    assert scan is not None
    ranges = np.asarray(scan.ranges)
    bearings = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
    ahead = ranges[np.cos(bearings) >= math.cos(math.radians(nodes.HALF_SECTOR))]
    counts = ahead[np.isinf(ahead) | ((ahead >= scan.range_min) & (ahead <= scan.range_max))]
    if not len(counts):
        return Command()
    near = counts.min() < nodes.SAFETY_DISTANCE
    return Command(angular=nodes.TURN) if near else Command(linear=nodes.FORWARD)
