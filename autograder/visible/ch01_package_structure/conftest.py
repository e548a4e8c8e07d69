"""Fixtures of the suite: what was installed, and numbers drawn from the seed."""

from __future__ import annotations

import random

import pytest

from autograder.lab import Workspace
from autograder.probes.installed import Installed, look
from autograder.visible.ch01_package_structure import contract


@pytest.fixture(scope="session")
def dance(workspace: Workspace) -> Installed:
    """What was installed of the package that the student makes."""
    return look(workspace.install, contract.DANCE)


@pytest.fixture(scope="session")
def watch(workspace: Workspace) -> Installed:
    """What was installed of the package that the student repairs."""
    return look(workspace.install, contract.WATCH)


@pytest.fixture
def draw(request: pytest.FixtureRequest, seed: int) -> random.Random:
    """Random numbers of this check, the same for the same seed."""
    return random.Random(f"{seed}:{request.function.__name__}")
