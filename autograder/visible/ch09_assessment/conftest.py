"""Fixtures of the suite: the message types, the labs, and numbers drawn from the seed."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest

from autograder.lab import Workspace
from autograder.visible.ch09_assessment.robot import NodeLab, Types

Start = Callable[..., NodeLab]


@pytest.fixture(scope="session")
def types(workspace: Workspace) -> Types:
    """The student's messages."""
    return Types.of(workspace)


@pytest.fixture(scope="session")
def start(workspace: Workspace, types: Types) -> Start:
    """Return a lab of a node of this name, with these parameters, each time it is called."""
    return lambda name, **parameters: NodeLab(workspace, types, name, **parameters)


@pytest.fixture
def draw(request: pytest.FixtureRequest, seed: int) -> random.Random:
    """Random numbers of this check, the same for the same seed."""
    return random.Random(f"{seed}:{request.function.__name__}")
