"""Fixtures of the suite: the student's own interfaces, the nodes in the harness."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Generic, TypeVar

import pytest

from autograder.checks.ch03_interfaces.support.driver import Driver
from autograder.checks.ch03_interfaces.support.reporter import Reporter
from autograder.checks.ch03_interfaces.support.types import Types, load_types
from autograder.harness import AutoHarness, Workspace

AnyHarness = TypeVar("AnyHarness", bound=AutoHarness)


class Shared(Generic[AnyHarness]):
    """Keeps one harness for several checks, and replaces it once its program has ended."""

    def __init__(self, make: Callable[[], AnyHarness]) -> None:
        self._make, self._stack = make, ExitStack()
        self._harness: AnyHarness | None = None

    def harness(self) -> AnyHarness:
        """Return a harness whose program runs."""
        harness = self._harness
        if harness is None or harness.process.ending is not None:
            self.close()
            harness = self._make()
            self._stack.enter_context(harness)
            self._harness = harness
        return harness

    def close(self) -> None:
        """Let the present harness go."""
        self._harness = None
        self._stack.close()


def _shared(make: Callable[[], AnyHarness]) -> Iterator[Shared[AnyHarness]]:
    shared = Shared(make)
    yield shared
    shared.close()


@pytest.fixture(scope="session")
def types(workspace: Workspace) -> Types:
    """The student's message, service and action, rebuilt from their texts."""
    return load_types(workspace)


@pytest.fixture(scope="session")
def reporters(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """Where the shared status publisher is kept."""
    yield from _shared(lambda: Reporter(workspace, types))


@pytest.fixture
def reporter(reporters: Shared[Reporter]) -> Reporter:
    """The status publisher; it has met the sensors of earlier checks."""
    return reporters.harness()


@pytest.fixture(scope="session")
def silent_reporters(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """Where the status publisher is kept that no sensor ever speaks to."""
    yield from _shared(lambda: Reporter(workspace, types))


@pytest.fixture
def silent_reporter(silent_reporters: Shared[Reporter]) -> Reporter:
    """A status publisher that has not heard of any sensor."""
    return silent_reporters.harness()


@pytest.fixture(scope="session")
def drivers(workspace: Workspace, types: Types) -> Iterator[Shared[Driver]]:
    """Where the shared distance driver is kept."""
    yield from _shared(lambda: Driver(workspace, types))


@pytest.fixture
def driver(drivers: Shared[Driver]) -> Driver:
    """The distance driver, on wheels that the grader turns."""
    return drivers.harness()


@pytest.fixture
def ready(driver: Driver, draw: random.Random) -> Driver:
    """The distance driver somewhere on the plane, askew to both axes, and it has heard where."""
    heading = draw.choice((0.0, math.pi / 2.0, math.pi, -math.pi / 2.0)) + draw.uniform(0.65, 0.9)
    driver.place(draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0), heading)
    return driver
