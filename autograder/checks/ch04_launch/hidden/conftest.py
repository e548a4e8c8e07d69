"""Fixtures of the hidden checks: launches that several checks share, and inputs drawn from the seed."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from autograder.checking import Workspace
from autograder.checks.ch04_launch.hidden.inputs import Inputs, draw_inputs
from autograder.checks.ch04_launch.hidden.launches import Launches


@pytest.fixture(scope="session")
def inputs(seed: int) -> Inputs:
    """The hidden inputs of this grading."""
    return draw_inputs(random.Random(f"{seed}:launch"))


@pytest.fixture(scope="module")
def launches(workspace: Workspace, inputs: Inputs) -> Iterator[Launches]:
    """The launches of one module's checks; each is started when a check first uses it."""
    launches = Launches(workspace, inputs)
    yield launches
    launches.close()
