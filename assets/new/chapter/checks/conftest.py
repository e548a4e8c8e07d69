"""Fixtures that the visible and the hidden checks share."""

from collections.abc import Iterator

import pytest

from autograder.checking import Shared, Workspace
from autograder.checks.chNEW_CHAPTER.support.robot import Robot


@pytest.fixture(scope="session")
def shared_robot(workspace: Workspace) -> Iterator[Shared[Robot]]:
    """Provide the robot that several checks share."""
    with Shared(lambda: Robot(workspace)) as shared:
        yield shared


@pytest.fixture
def robot(shared_robot: Shared[Robot]) -> Robot:
    """The student's node, started once for all checks. It may have seen other scans before."""
    return shared_robot.get()
