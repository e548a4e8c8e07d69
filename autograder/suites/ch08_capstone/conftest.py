"""The fixtures of the visible checks serve the hidden ones, too; and the drives through hidden worlds."""

from __future__ import annotations

import pytest

from autograder.suites.ch08_capstone.drives import Drives
from autograder.visible.ch08_capstone.conftest import Stable, draw, stable, system
from autograder.visible.ch08_capstone.contract import CONTROLLER, PROCESSOR
from autograder.visible.ch08_capstone.system import System

__all__ = ["draw", "drives", "driving", "seeing", "stable", "system"]


@pytest.fixture
def seeing(stable: Stable) -> System:
    """The system for a check that needs the processor alone."""
    return stable.system(PROCESSOR)


@pytest.fixture
def driving(stable: Stable) -> System:
    """The system for a check that needs the processor and the controller."""
    return stable.system(PROCESSOR, CONTROLLER)


@pytest.fixture(scope="session")
def drives(stable: Stable, seed: int) -> Drives:
    """The drives of this submission."""
    return Drives(lambda: stable.system(PROCESSOR, CONTROLLER), seed)
