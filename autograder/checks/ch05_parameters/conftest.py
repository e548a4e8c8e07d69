"""Fixtures of the suite: a node that several checks share, nodes of their own."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.checking import Shared, Workspace
from autograder.checks.ch05_parameters.support.robot import Robot, restore


@pytest.fixture(scope="session")
def shared_robot(workspace: Workspace) -> Iterator[Shared[Robot]]:
    """Keeps the node that several checks share, as long as it can be given back the values of the contract."""
    with Shared(lambda: Robot(workspace), restore) as shared:
        yield shared


@pytest.fixture
def robot(shared_robot: Shared[Robot]) -> Robot:
    """A node with the values of the contract that other checks have already asked and changed.

    A new one has its own defaults.
    """
    return shared_robot.get()


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A node that was started for this check."""
    with Robot(workspace) as robot:
        yield robot
