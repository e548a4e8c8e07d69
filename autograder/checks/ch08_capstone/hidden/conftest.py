"""Fixtures of the hidden checks: systems with some of the programs, and drives through hidden worlds."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pytest

from autograder.checking import Workspace
from autograder.checks.ch08_capstone.hidden.drives import Drives
from autograder.checks.ch08_capstone.hidden.fallback import BodyRunner, run_with_fallback
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, MONITOR, PROCESSOR
from autograder.checks.ch08_capstone.support.system import SharedSystem, System

SLOW_CLOCK_RATE = 0.25  # s on the machine's clocks in a second of ROS time; correct programs do not read these clocks


@pytest.fixture
def processor_system(shared_system: SharedSystem) -> System:
    """The system for a check that needs only the processor."""
    return shared_system.get(PROCESSOR)


@pytest.fixture
def driving_system(shared_system: SharedSystem) -> System:
    """The system for a check that needs the processor and the controller."""
    return shared_system.get(PROCESSOR, CONTROLLER)


@pytest.fixture(scope="session")
def slow_system(workspace: Workspace) -> Iterator[SharedSystem]:
    """A shared system on a machine whose clocks are slower than ROS time."""
    shared = SharedSystem(workspace, SLOW_CLOCK_RATE)
    yield shared
    shared.close()


@pytest.fixture(scope="session")
def lone_controller(workspace: Workspace) -> Iterator[SharedSystem]:
    """The controller alone, to which the expected clearances are sent."""
    shared = SharedSystem(workspace, absent_programs=(PROCESSOR, MONITOR), sends_clearances=True)
    yield shared
    shared.close()


@pytest.fixture
def judge_driving(shared_system: SharedSystem, lone_controller: SharedSystem) -> BodyRunner:
    """Judges the controller with the student's processor and, if that fails, with the expected clearances."""
    return partial(run_with_fallback, shared_system, lone_controller)


@pytest.fixture(scope="session")
def lone_monitor(workspace: Workspace) -> Iterator[SharedSystem]:
    """The monitor alone; checks publish the messages of the other two programs."""
    shared = SharedSystem(workspace, absent_programs=(PROCESSOR, CONTROLLER))
    yield shared
    shared.close()


@pytest.fixture(scope="session")
def drives(shared_system: SharedSystem, seed: int) -> Drives:
    """The drives of this submission."""
    return Drives(lambda: shared_system.get(PROCESSOR, CONTROLLER), seed)
