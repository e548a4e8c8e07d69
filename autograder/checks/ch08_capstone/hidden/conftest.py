"""Fixtures of the hidden checks: parts of the system, and the drives through hidden worlds."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pytest

from autograder.checking import Workspace
from autograder.checks.ch08_capstone.hidden import judges
from autograder.checks.ch08_capstone.hidden.drives import Drives
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, MONITOR, PROCESSOR
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

SLOW = 0.25  # of ROS time: how fast the machine's clocks run for programs that must not look at them


@pytest.fixture
def seeing(shared_system: SharedSystem) -> System:
    """The system for a check that needs the processor alone."""
    return shared_system.get(PROCESSOR)


@pytest.fixture
def driving(shared_system: SharedSystem) -> System:
    """The system for a check that needs the processor and the controller."""
    return shared_system.get(PROCESSOR, CONTROLLER)


@pytest.fixture(scope="session")
def slow_system(workspace: Workspace) -> Iterator[SharedSystem]:
    """Keeps the system of a machine whose clocks are slower than ROS time."""
    shared = SharedSystem(workspace, SLOW)
    yield shared
    shared.close()


@pytest.fixture(scope="session")
def lone_controller(workspace: Workspace) -> Iterator[SharedSystem]:
    """Keeps the controller alone, to which right clearances are sent."""
    shared = SharedSystem(workspace, absent=(PROCESSOR, MONITOR), stands_in=True)
    yield shared
    shared.close()


@pytest.fixture
def judge_driving(shared_system: SharedSystem, lone_controller: SharedSystem) -> judges.JudgeDriving:
    """Judges the controller: behind the student's processor and, if that fails, by right clearances."""
    return partial(judges.judge_driving, shared_system, lone_controller)


@pytest.fixture(scope="session")
def lone_monitor(workspace: Workspace) -> Iterator[SharedSystem]:
    """Keeps the monitor alone; a check speaks for the other two."""
    shared = SharedSystem(workspace, absent=(PROCESSOR, CONTROLLER))
    yield shared
    shared.close()


@pytest.fixture(scope="session")
def drives(shared_system: SharedSystem, seed: int) -> Drives:
    """The drives of this submission."""
    return Drives(lambda: shared_system.get(PROCESSOR, CONTROLLER), seed)
