"""Fixtures of the suite: the nodes in the lab, and numbers drawn from the seed."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.lab import Workspace
from autograder.visible.ch07_best_practices.robot import Processor


@pytest.fixture(scope="module")
def processor(workspace: Workspace) -> Iterator[Processor]:
    """The sensor processor, which several checks share."""
    with Processor(workspace) as lab:
        yield lab


@pytest.fixture
def fresh_processor(workspace: Workspace) -> Iterator[Processor]:
    """A sensor processor that has seen nothing yet."""
    with Processor(workspace) as lab:
        yield lab


@pytest.fixture
def draw(request: pytest.FixtureRequest, seed: int) -> random.Random:
    """Random numbers of this check, the same for the same seed."""
    return random.Random(f"{seed}:{request.function.__name__}")
