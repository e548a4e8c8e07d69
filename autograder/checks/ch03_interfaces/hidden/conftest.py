"""Fixtures of the hidden checks: a status publisher that is started with parameters."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.checks.ch03_interfaces.support.reporter import Reporter
from autograder.checks.ch03_interfaces.support.types import Types
from autograder.harness import Shared, Workspace

TUNED_PERIOD = 0.25  # s


@pytest.fixture(scope="session")
def tuned_name(seed: int) -> str:
    """The name that the tuned status publisher is given."""
    return f"Rover{random.Random(f'{seed}:name').randrange(100, 1000)}"


@pytest.fixture(scope="session")
def shared_tuned_reporter(workspace: Workspace, types: Types, tuned_name: str) -> Iterator[Shared[Reporter]]:
    """Keeps the status publisher that is given other parameters."""
    arguments = ("--ros-args", "-p", f"status_period:={TUNED_PERIOD}", "-p", f"robot_name:={tuned_name}")
    with Shared(lambda: Reporter(workspace, types, arguments)) as shared:
        yield shared


@pytest.fixture
def tuned_reporter(shared_tuned_reporter: Shared[Reporter]) -> Reporter:
    """The status publisher with a name and a period that it is given."""
    return shared_tuned_reporter.get()
