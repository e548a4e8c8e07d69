"""Fixtures of the suite: a node that several checks share, and a new node for a single check."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.checking import Shared, Workspace
from autograder.checks.ch05_parameters.support.robot import Robot, restore


@pytest.fixture(scope="session")
def shared_robot(workspace: Workspace) -> Iterator[Shared[Robot]]:
    """The shared node, which is restarted if its parameters cannot be reset to the contract's defaults."""
    with Shared(lambda: Robot(workspace), restore) as shared:
        yield shared


@pytest.fixture
def robot(shared_robot: Shared[Robot]) -> Robot:
    """The node that several checks share, with its parameters reset to the contract's defaults.

    If it has just been started, it still has its own defaults.
    """
    return shared_robot.get()


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A node that was started for this check only."""
    with Robot(workspace) as robot:
        yield robot
