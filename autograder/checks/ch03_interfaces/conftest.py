"""Fixtures that the visible and the hidden checks share: the student's interfaces, and nodes in a harness."""

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
    """The classes of the student's message, service and action."""
    return load_types(workspace)


@pytest.fixture(scope="session")
def shared_reporter(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """The status publisher that several checks share."""
    with Shared(lambda: Reporter(workspace, types)) as shared:
        yield shared


@pytest.fixture
def reporter(shared_reporter: Shared[Reporter]) -> Reporter:
    """The status publisher, which has received sensor messages in earlier checks."""
    return shared_reporter.get()


@pytest.fixture(scope="session")
def shared_silent_reporter(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """The status publisher that never receives a sensor message."""
    with Shared(lambda: Reporter(workspace, types)) as shared:
        yield shared


@pytest.fixture
def silent_reporter(shared_silent_reporter: Shared[Reporter]) -> Reporter:
    """A status publisher that has received no sensor message."""
    return shared_silent_reporter.get()


@pytest.fixture(scope="session")
def shared_driver(workspace: Workspace, types: Types) -> Iterator[Shared[Driver]]:
    """The distance driver that several checks share."""
    with Shared(lambda: Driver(workspace, types)) as shared:
        yield shared


@pytest.fixture
def driver(shared_driver: Shared[Driver]) -> Driver:
    """The distance driver, whose robot the grader simulates."""
    return shared_driver.get()


@pytest.fixture
def free_driver(placed_driver: Driver) -> Driver:
    """A distance driver that has received its pose and no goal."""
    if placed_driver.has_goals:
        placed_driver.restart()
    return placed_driver


@pytest.fixture
def placed_driver(driver: Driver, draw: random.Random) -> Driver:
    """The distance driver, which has received a random pose that is oblique to both axes."""
    heading = draw.choice((0.0, math.pi / 2.0, math.pi, -math.pi / 2.0)) + draw.uniform(0.65, 0.9)
    driver.place(draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0), heading)
    return driver
