"""Fixtures of the suite: robots in the harness."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.checks.ch02_nodes.support.robot import Robot
from autograder.harness import Shared, Workspace


@pytest.fixture(scope="session")
def shared_robot(workspace: Workspace) -> Iterator[Shared[Robot]]:
    """Keeps the robot that several checks share."""
    with Shared(lambda: Robot(workspace)) as shared:
        yield shared


@pytest.fixture
def robot(shared_robot: Shared[Robot]) -> Robot:
    """A robot that has already seen other scans; each check shows it at least a second of its own."""
    return shared_robot.get()


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A robot that was started for this check."""
    with Robot(workspace) as robot:
        yield robot
