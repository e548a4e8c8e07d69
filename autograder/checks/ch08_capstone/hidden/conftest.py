"""Fixtures of the hidden checks: parts of the system, and the drives through hidden worlds."""

from __future__ import annotations

import pytest

from autograder.checks.ch08_capstone.conftest import Stable
from autograder.checks.ch08_capstone.hidden.drives import Drives
from autograder.checks.ch08_capstone.support.contract import CONTROLLER, PROCESSOR
from autograder.checks.ch08_capstone.support.system import System


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
