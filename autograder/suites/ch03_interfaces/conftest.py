"""The fixtures of the visible checks serve the hidden ones, too; and one program takes its parameters."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.lab import Workspace
from autograder.visible.ch03_interfaces.conftest import (
    Shared,
    draw,
    driver,
    drivers,
    ready,
    reporter,
    reporters,
    silent_reporter,
    silent_reporters,
    types,
)
from autograder.visible.ch03_interfaces.reporter import Reporter
from autograder.visible.ch03_interfaces.types import Types

__all__ = [
    "draw",
    "driver",
    "drivers",
    "ready",
    "reporter",
    "reporters",
    "silent_reporter",
    "silent_reporters",
    "types",
]
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
    return tuned_reporters.lab()
