"""Fixtures that the visible and the hidden checks share: robots in a harness."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from sensor_msgs.msg import LaserScan

from autograder.checking import ReceivedMessage, Shared, StudentError, Workspace
from autograder.checks.ch02_nodes.support.robot import Reactions, Robot, observed_reactions
from autograder.checks.ch02_nodes.support.scans import JUST_AHEAD, scan
from autograder.checks.ch02_nodes.support.two_nodes import TwoNodes, call_two_nodes


@pytest.fixture(scope="session")
def shared_robot(workspace: Workspace) -> Iterator[Shared[Robot]]:
    """The robot that several checks share."""
    with Shared(lambda: Robot(workspace)) as shared:
        yield shared


@pytest.fixture
def robot(shared_robot: Shared[Robot]) -> Robot:
    """A robot that has received other scans before; each check publishes its own for at least a second."""
    return shared_robot.get()


@pytest.fixture(scope="session")
def reactions(shared_robot: Shared[Robot]) -> Reactions:
    """The commands with which the shared robot reacts to a clear path and to an obstacle."""
    return observed_reactions(
        _commands_for(shared_robot, scan(fill=2.0)), _commands_for(shared_robot, scan(JUST_AHEAD))
    )


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A robot that was started for this check."""
    with Robot(workspace) as robot:
        yield robot


@pytest.fixture(scope="session")
def two_nodes(workspace: Workspace) -> TwoNodes:
    """Two objects of the node's class in one process, one of which has received a scan."""
    return call_two_nodes(workspace)


def _commands_for(shared: Shared[Robot], message: LaserScan) -> list[ReceivedMessage]:
    try:
        return shared.get().see(message)
    except StudentError:  # the checks that publish such a scan report the error
        return []
