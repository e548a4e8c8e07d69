"""Fixtures of the suite: what was installed."""

from __future__ import annotations

import pytest

from autograder.checks.ch01_package_structure.support import contract
from autograder.harness import Workspace
from autograder.probes.installed import Installed, look


@pytest.fixture(scope="session")
def installed_dance(workspace: Workspace) -> Installed:
    """What was installed of the package that the student makes."""
    return look(workspace.install, contract.SQUARE_DANCE)


@pytest.fixture(scope="session")
def installed_alarm(workspace: Workspace) -> Installed:
    """What was installed of the package that the student repairs."""
    return look(workspace.install, contract.WALL_ALARM)
