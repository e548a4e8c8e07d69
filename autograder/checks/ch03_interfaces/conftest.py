"""Fixtures of the suite: the student's own interfaces, the nodes in the harness."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator

import pytest

from autograder.checking import Shared, Workspace
from autograder.checks.ch03_interfaces.support.driver import Driver
from autograder.checks.ch03_interfaces.support.reporter import Reporter
from autograder.checks.ch03_interfaces.support.types import Types, load_types


@pytest.fixture(scope="session")
def types(workspace: Workspace) -> Types:
    """The student's message, service and action, rebuilt from their texts."""
    return load_types(workspace)


@pytest.fixture(scope="session")
def shared_reporter(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """Keeps the status publisher that several checks share."""
    with Shared(lambda: Reporter(workspace, types)) as shared:
        yield shared


@pytest.fixture
def reporter(shared_reporter: Shared[Reporter]) -> Reporter:
    """The status publisher; it has met the sensors of earlier checks."""
    return shared_reporter.get()


@pytest.fixture(scope="session")
def shared_silent_reporter(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """Keeps the status publisher that no sensor ever speaks to."""
    with Shared(lambda: Reporter(workspace, types)) as shared:
        yield shared


@pytest.fixture
def silent_reporter(shared_silent_reporter: Shared[Reporter]) -> Reporter:
    """A status publisher that has not heard of any sensor."""
    return shared_silent_reporter.get()


@pytest.fixture(scope="session")
def shared_driver(workspace: Workspace, types: Types) -> Iterator[Shared[Driver]]:
    """Keeps the distance driver that several checks share."""
    with Shared(lambda: Driver(workspace, types)) as shared:
        yield shared


@pytest.fixture
def driver(shared_driver: Shared[Driver]) -> Driver:
    """The distance driver, on wheels that the grader turns."""
    return shared_driver.get()


@pytest.fixture
def free_driver(placed_driver: Driver) -> Driver:
    """A distance driver that has never been sent a goal, and has heard where it is."""
    if placed_driver.used:
        placed_driver.restart()
    return placed_driver


@pytest.fixture
def placed_driver(driver: Driver, draw: random.Random) -> Driver:
    """The distance driver somewhere on the plane, askew to both axes, and it has heard where."""
    heading = draw.choice((0.0, math.pi / 2.0, math.pi, -math.pi / 2.0)) + draw.uniform(0.65, 0.9)
    driver.place(draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0), heading)
    return driver
