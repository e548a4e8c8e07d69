"""Fixtures of the suite: a node that several checks share, nodes of their own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from autograder.checks.ch05_parameters.support.contract import CHANGEABLE
from autograder.checks.ch05_parameters.support.robot import Robot
from autograder.harness import Workspace
from autograder.probes.parameters import as_declared, differences


class Stable:
    """Keeps one node for several checks.

    A check gets it with the values of the contract, whatever its own defaults are and whatever an earlier check has
    set; if that is not possible, it gets a new one.
    """

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._stack = ExitStack()
        self._robot: Robot | None = None

    def robot(self) -> Robot:
        """Return a node that runs, with the values of the contract."""
        if self._robot is None or self._robot.process.ending is not None or not self._is_restored(self._robot):
            self.close()
            self._robot = self._stack.enter_context(Robot(self._workspace))
        return self._robot

    def close(self) -> None:
        """Let the present node go."""
        self._robot = None
        self._stack.close()

    @staticmethod
    def _is_restored(robot: Robot) -> bool:
        wanted = as_declared({name: CHANGEABLE[name] for name in CHANGEABLE if name in robot.initial}, robot.initial)
        found = robot.parameters.values(*wanted)
        return not differences(found, wanted) or robot.parameters.change(wanted).accepted


@pytest.fixture(scope="session")
def stable(workspace: Workspace) -> Iterator[Stable]:
    """The place where the shared node stands."""
    place = Stable(workspace)
    yield place
    place.close()


@pytest.fixture
def robot(stable: Stable) -> Robot:
    """A node with the values of the contract that other checks have already asked and changed."""
    return stable.robot()


@pytest.fixture
def fresh_robot(workspace: Workspace) -> Iterator[Robot]:
    """A node that was started for this check."""
    with Robot(workspace) as robot:
        yield robot
