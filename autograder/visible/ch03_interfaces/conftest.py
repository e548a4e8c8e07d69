"""Fixtures of the suite: the student's own interfaces, the nodes in the lab, and numbers drawn from the seed."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Generic, TypeVar

import pytest

from autograder.lab import Lab, Workspace
from autograder.visible.ch03_interfaces.driver import Driver
from autograder.visible.ch03_interfaces.reporter import Reporter
from autograder.visible.ch03_interfaces.types import Types, load_types

AnyLab = TypeVar("AnyLab", bound=Lab)


class Shared(Generic[AnyLab]):
    """Keeps one lab for several checks, and replaces it once its program has ended."""

    def __init__(self, make: Callable[[], AnyLab]) -> None:
        self._make, self._stack = make, ExitStack()
        self._lab: AnyLab | None = None

    def lab(self) -> AnyLab:
        """Return a lab whose program runs."""
        lab = self._lab
        if lab is None or lab.process.ending is not None:
            self.close()
            lab = self._make()
            self._stack.enter_context(lab)
            self._lab = lab
        return lab

    def close(self) -> None:
        """Let the present lab go."""
        self._lab = None
        self._stack.close()


def _shared(make: Callable[[], AnyLab]) -> Iterator[Shared[AnyLab]]:
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
    return reporters.lab()


@pytest.fixture(scope="session")
def silent_reporters(workspace: Workspace, types: Types) -> Iterator[Shared[Reporter]]:
    """Where the status publisher is kept that no sensor ever speaks to."""
    yield from _shared(lambda: Reporter(workspace, types))


@pytest.fixture
def silent_reporter(silent_reporters: Shared[Reporter]) -> Reporter:
    """A status publisher that has not heard of any sensor."""
    return silent_reporters.lab()


@pytest.fixture(scope="session")
def drivers(workspace: Workspace, types: Types) -> Iterator[Shared[Driver]]:
    """Where the shared distance driver is kept."""
    yield from _shared(lambda: Driver(workspace, types))


@pytest.fixture
def driver(drivers: Shared[Driver]) -> Driver:
    """The distance driver, on wheels that the grader turns."""
    return drivers.lab()


@pytest.fixture
def ready(driver: Driver, draw: random.Random) -> Driver:
    """The distance driver somewhere on the plane, askew to both axes, and it has heard where."""
    heading = draw.choice((0.0, math.pi / 2.0, math.pi, -math.pi / 2.0)) + draw.uniform(0.65, 0.9)
    driver.place(draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0), heading)
    return driver


@pytest.fixture
def draw(request: pytest.FixtureRequest, seed: int) -> random.Random:
    """Random numbers of this check, the same for the same seed."""
    return random.Random(f"{seed}:{request.function.__name__}")
