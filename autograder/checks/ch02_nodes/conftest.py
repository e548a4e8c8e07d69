"""Fixtures of the suite: robots in the harness."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from autograder.checks.ch02_nodes.support.robot import Robot
from autograder.harness import Workspace


class Stable:
    """Keeps one robot for several checks, and replaces it once its program has ended."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._stack = ExitStack()
        self._robot: Robot | None = None

    def robot(self) -> Robot:
        """Return a robot whose program runs."""
        if self._robot is None or self._robot.process.ending is not None:
            self.close()
            self._robot = Robot(self._workspace)
            self._stack.enter_context(self._robot)
        return self._robot

    def close(self) -> None:
        """Let the present robot go."""
        self._robot = None
        self._stack.close()


@pytest.fixture(scope="session")
def stable(workspace: Workspace) -> Iterator[Stable]:
    """The place where the shared robot stands."""
    place = Stable(workspace)
    yield place
    place.close()


@pytest.fixture
def robot(stable: Stable) -> Robot:
    """A robot that has already seen other scans; each check shows it at least a second of its own."""
    return stable.robot()


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A robot that was started for this check."""
    with Robot(workspace) as robot:
        yield robot
