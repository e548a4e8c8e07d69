"""Fixtures of the suite: sensor processors in the harness, and runs of robust nodes."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.checking import Workspace
from autograder.checks.ch07_best_practices.support.robot import Processor
from autograder.checks.ch07_best_practices.support.sensor_run import SensorRun, dead_sensor, flaky_sensor


@pytest.fixture(scope="module")
def processor(workspace: Workspace) -> Iterator[Processor]:
    """A sensor processor that several checks share."""
    with Processor(workspace) as harness:
        yield harness


@pytest.fixture
def fresh_processor(workspace: Workspace) -> Iterator[Processor]:
    """A sensor processor that has not received a scan."""
    with Processor(workspace) as harness:
        yield harness


@pytest.fixture(scope="module")
def dead_run(workspace: Workspace, seed: int) -> SensorRun:
    """A run of a robust node whose readings all fail; several checks share it."""
    return dead_sensor(workspace, random.Random(f"{seed}:dead"))


@pytest.fixture(scope="module")
def flaky_run(workspace: Workspace, seed: int) -> SensorRun:
    """A run of a robust node whose readings fail in many series; several checks share it."""
    return flaky_sensor(workspace, random.Random(f"{seed}:flaky"))
