"""The fixtures of the visible checks serve the hidden ones, too; and a copy of the package that has grown."""

from __future__ import annotations

import random

import pytest

from autograder.lab import Workspace
from autograder.suites.ch01_package_structure.growth import Grown, grow
from autograder.visible.ch01_package_structure.conftest import dance, draw, watch

__all__ = ["dance", "draw", "grown", "watch"]


@pytest.fixture(scope="session")
def grown(workspace: Workspace, seed: int) -> Grown:
    """The student's package with a launch file, a configuration and a subpackage more, built again."""
    return grow(workspace, random.Random(f"{seed}:grown"))
