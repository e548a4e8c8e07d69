"""The fixtures of the visible checks serve the hidden ones, too; and the drives through hidden worlds."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from autograder.suites.ch08_capstone.drives import Drives
from autograder.visible.ch08_capstone.conftest import draw, running, stable, system
from autograder.visible.ch08_capstone.system import System

__all__ = ["draw", "drives", "running", "stable", "system"]


@pytest.fixture(scope="session")
def drives(running: Callable[[], System], seed: int) -> Drives:
    """The drives of this submission."""
    return Drives(running, seed)
