"""Fixtures of the hidden checks: nodes with other parameters or other clocks."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.checking import Shared, Workspace
from autograder.checking.probes import parameters
from autograder.checks.ch03_interfaces.hidden.status import TUNED_PERIOD
from autograder.checks.ch03_interfaces.support.driver import Driver
from autograder.checks.ch03_interfaces.support.reporter import Reporter
from autograder.checks.ch03_interfaces.support.types import Types

ODD_PERIOD = 0.7  # s, so that most statuses are published between two whole seconds
FAST, SLOW = 4.0, 0.02  # s that the machine's clocks count in 1 s of ROS time


@pytest.fixture(scope="session")
def tuned_name(seed: int) -> str:
    """The robot name of the tuned status publisher."""
    return f"Rover{random.Random(f'{seed}:name').randrange(100, 1000)}"


@pytest.fixture(scope="session")
def shared_tuned_reporter(workspace: Workspace, types: Types, tuned_name: str) -> Iterator[Shared[Reporter]]:
    """The status publisher with other parameters, which several checks share."""
    arguments = (
        "--ros-args",
        *parameters.override_arguments({"status_period": TUNED_PERIOD, "robot_name": tuned_name}),
    )
    with Shared(lambda: Reporter(workspace, types, arguments)) as shared:
        yield shared


@pytest.fixture
def tuned_reporter(shared_tuned_reporter: Shared[Reporter]) -> Reporter:
    """The status publisher with another name and another period."""
    return shared_tuned_reporter.get()


@pytest.fixture
def fast_clock_reporter(workspace: Workspace, types: Types) -> Iterator[Reporter]:
    """A status publisher with an odd period, on a machine whose clocks are faster than ROS time."""
    arguments = ("--ros-args", *parameters.override_arguments({"status_period": ODD_PERIOD}))
    with Reporter(workspace, types, arguments, clock_rate=FAST) as reporter:
        yield reporter


@pytest.fixture
def slow_clock_driver(workspace: Workspace, types: Types) -> Iterator[Driver]:
    """A distance driver that has received its pose, on a machine whose clocks are slower than ROS time."""
    with Driver(workspace, types, clock_rate=SLOW) as driver:
        driver.place(0.0, 0.0, 0.7)
        yield driver
