"""Fixtures of the hidden checks: a status publisher that is started with parameters."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.checks.ch03_interfaces.conftest import Shared
from autograder.checks.ch03_interfaces.support.reporter import Reporter
from autograder.checks.ch03_interfaces.support.types import Types
from autograder.harness import Workspace

TUNED_PERIOD = 0.25  # s


@pytest.fixture(scope="session")
def tuned_name(seed: int) -> str:
    """The name that the tuned status publisher is given."""
    return f"Rover{random.Random(f'{seed}:name').randrange(100, 1000)}"


@pytest.fixture(scope="session")
def tuned_reporters(workspace: Workspace, types: Types, tuned_name: str) -> Iterator[Shared[Reporter]]:
    """Where the status publisher is kept that is given other parameters."""
    arguments = ("--ros-args", "-p", f"status_period:={TUNED_PERIOD}", "-p", f"robot_name:={tuned_name}")
    shared = Shared(lambda: Reporter(workspace, types, arguments))
    yield shared
    shared.close()


@pytest.fixture
def tuned_reporter(tuned_reporters: Shared[Reporter]) -> Reporter:
    """The status publisher with a name and a period that it is given."""
    return tuned_reporters.harness()
