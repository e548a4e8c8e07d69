"""A robot that turns where something is ahead acts on what it sees; one that turns anywhere is blind."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from autograder.checks.ch02_nodes.hidden.blindness import driven_distances, turns_at_obstacles
from sim import Command, Pose, Recording, RobotSpec, Scan, Simulation, State, World, box, run

AHEAD = 1.25  # m
SECONDS = 10.0
ON, LEFT, RIGHT = Command(0.3, 0.0), Command(0.0, 0.5), Command(0.0, -0.5)


def _sees(scan: Scan) -> bool:
    """Return whether something is within 1 m, 20 degrees to each side."""
    return float(np.min(np.r_[scan.ranges[:21], scan.ranges[-20:]])) < 1.0


def _drive(decide: Callable[[Scan], Command]) -> Recording:
    room = World.from_segments(box(5.0, 5.0), starts=[Pose(0.0, 0.0, 0.3)])

    def policy(state: State, scans: dict[str, Scan | None]) -> Command:
        scan = scans["robot"]
        assert scan is not None
        return decide(scan)

    return run(Simulation(room, (RobotSpec(radius=0.18),), seed=1), policy, SECONDS)


@pytest.mark.parametrize("turn", [LEFT, RIGHT])
def test_a_robot_that_turns_before_a_wall_acts_on_what_it_sees(turn: Command) -> None:
    drive = _drive(lambda scan: turn if _sees(scan) else ON)
    assert turns_at_obstacles(drive, AHEAD)
    first = float(drive.times[np.abs(drive.velocities[:, 0, 1]) > 0.1][0])
    assert not turns_at_obstacles(drive, AHEAD, until=first - 0.1)


@pytest.mark.parametrize(
    "command",
    [Command(), ON, LEFT, Command(0.1, 0.5)],
    ids=["stands still", "drives straight on", "spins", "circles"],
)
def test_a_robot_that_always_does_the_same_acts_on_nothing(command: Command) -> None:
    assert not turns_at_obstacles(_drive(lambda scan: command), AHEAD)


def test_a_robot_that_turns_where_the_way_is_clear_does_not_act_on_what_it_sees() -> None:
    assert not turns_at_obstacles(_drive(lambda scan: ON if _sees(scan) else Command(0.1, 0.5)), AHEAD)


def test_a_path_is_the_metres_driven_so_far() -> None:
    metres = driven_distances(_drive(lambda scan: Command(0.1, 0.5)))
    assert metres[0] == 0.0
    assert (np.diff(metres) >= 0.0).all()
    assert metres[-1] == pytest.approx(0.1 * SECONDS, abs=0.05)
