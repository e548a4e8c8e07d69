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
def dead(workspace: Workspace, seed: int) -> SensorRun:
    """A robust node whose readings all fail, which several checks share."""
    return dead_sensor(workspace, random.Random(f"{seed}:dead"))


@pytest.fixture(scope="module")
def flaky(workspace: Workspace, seed: int) -> SensorRun:
    """A robust node whose readings fail in many series, which several checks share."""
    return flaky_sensor(workspace, random.Random(f"{seed}:flaky"))
