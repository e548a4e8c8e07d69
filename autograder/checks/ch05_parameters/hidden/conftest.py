"""A fixture of the hidden checks: a node that is started with drawn values."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

import pytest

from autograder.checks.ch05_parameters.conftest import Stable
from autograder.checks.ch05_parameters.support.robot import Robot
from autograder.harness import Workspace
from autograder.probes.parameters import Value, as_declared


@dataclass(frozen=True)
class Custom:
    """A node that was started with values of its own, and those values."""

    robot: Robot
    values: dict[str, Value]
    velocity: float
    safety: float
    slow: float
    frequency: float
    threshold: int


@pytest.fixture(scope="session")
def custom(workspace: Workspace, stable: Stable, seed: int) -> Iterator[Custom]:
    """A node started with drawn values for all six parameters."""
    drawn = random.Random(f"{seed}:custom")
    velocity, safety = drawn.randrange(40, 80) / 100, drawn.randrange(70, 110) / 100
    slow = round(safety + drawn.randrange(30, 60) / 100, 2)
    frequency, threshold = drawn.choice((20.0, 25.0, 50.0)), drawn.randrange(35, 65)
    values: dict[str, Value] = {
        "robot_name": f"Robot{drawn.randrange(100, 999)}",
        "max_linear_velocity": velocity,
        "safety_distance": safety,
        "slow_distance": slow,
        "control_frequency": frequency,
        "battery_threshold": threshold,
    }
    values = as_declared(values, stable.robot().initial)
    with Robot(workspace, values) as robot:
        yield Custom(robot, values, velocity, safety, slow, frequency, threshold)
