"""Fixtures of the suite: robots in the harness."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from sensor_msgs.msg import LaserScan

from autograder.checking import ReceivedMessage, Shared, StudentError, Workspace
from autograder.checks.ch02_nodes.support.robot import Reactions, Robot, own_reactions
from autograder.checks.ch02_nodes.support.scans import JUST_AHEAD, scan


@pytest.fixture(scope="session")
def shared_robot(workspace: Workspace) -> Iterator[Shared[Robot]]:
    """Keeps the robot that several checks share."""
    with Shared(lambda: Robot(workspace)) as shared:
        yield shared


@pytest.fixture
def robot(shared_robot: Shared[Robot]) -> Robot:
    """A robot that has already seen other scans; each check shows it at least a second of its own."""
    return shared_robot.get()


@pytest.fixture(scope="session")
def own(shared_robot: Shared[Robot]) -> Reactions:
    """What this robot does where the way is clear, and where it is not."""
    return own_reactions(_seen(shared_robot, scan(fill=2.0)), _seen(shared_robot, scan(JUST_AHEAD)))


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A robot that was started for this check."""
    with Robot(workspace) as robot:
        yield robot


def _seen(shared: Shared[Robot], shown: LaserScan) -> list[ReceivedMessage]:
    try:
        return shared.get().see(shown)
    except StudentError:  # it is for the checks that show such a scan
        return []
