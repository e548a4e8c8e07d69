"""A fixture of the hidden checks: a copy of the package that has grown."""

from __future__ import annotations

import random

import pytest

from autograder.checks.ch01_package_structure.hidden.growth import Grown, grow
from autograder.harness import Workspace


@pytest.fixture(scope="session")
def grown(workspace: Workspace, seed: int) -> Grown:
    """The student's package with a launch file, a configuration and a subpackage more, built again."""
    return grow(workspace, random.Random(f"{seed}:grown"))
