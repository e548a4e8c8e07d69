"""Fixtures of the suite: the system in the harness."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.checking import Workspace
from autograder.checks.ch08_capstone.support.contract import PROGRAMS
from autograder.checks.ch08_capstone.support.system import SharedSystem, System


@pytest.fixture(scope="session")
def shared_system(workspace: Workspace) -> Iterator[SharedSystem]:
    """Keeps the system that several checks share."""
    shared = SharedSystem(workspace)
    yield shared
    shared.close()


@pytest.fixture
def system(shared_system: SharedSystem) -> System:
    """The system, which has seen other scans before; each check shows it an open space first, if that matters."""
    return shared_system.get(*PROGRAMS)
