"""Fixtures of the visible and the hidden checks: the student's programs in a harness."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.checking import Workspace
from autograder.checks.ch08_capstone.support.contract import PROGRAMS
from autograder.checks.ch08_capstone.support.system import SharedSystem, System


@pytest.fixture(scope="session")
def shared_system(workspace: Workspace) -> Iterator[SharedSystem]:
    """The system that several checks share."""
    shared = SharedSystem(workspace)
    yield shared
    shared.close()


@pytest.fixture
def system(shared_system: SharedSystem) -> System:
    """The system with all three programs.

    Other checks may have sent it scans before, so some checks first publish a scan of an open space.
    """
    return shared_system.get(*PROGRAMS)
