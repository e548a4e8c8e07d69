"""Fixtures of the suite: what was installed."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace
from autograder.checking.probes import installed
from autograder.checks.ch01_package_structure.support import contract


@pytest.fixture(scope="session")
def installed_dance(workspace: Workspace) -> installed.Installed:
    """What was installed of the package that the student makes."""
    return installed.look(workspace.install, contract.SQUARE_DANCE)


@pytest.fixture(scope="session")
def installed_alarm(workspace: Workspace) -> installed.Installed:
    """What was installed of the package that the student repairs."""
    return installed.look(workspace.install, contract.WALL_ALARM)
