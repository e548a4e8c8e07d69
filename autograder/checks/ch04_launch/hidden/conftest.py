"""Fixtures of the suite: launches that several checks look at, and numbers drawn from the seed."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.checking import Workspace
from autograder.checks.ch04_launch.hidden.inputs import Inputs, draw_inputs
from autograder.checks.ch04_launch.hidden.launches import Launches


@pytest.fixture(scope="session")
def inputs(seed: int) -> Inputs:
    """The hidden inputs of this run."""
    return draw_inputs(random.Random(f"{seed}:launch"))


@pytest.fixture(scope="module")
def launches(workspace: Workspace, inputs: Inputs) -> Iterator[Launches]:
    """Launches of one module's checks: each is started when it is first asked for."""
    launches = Launches(workspace, inputs)
    yield launches
    launches.close()
