"""Fixtures that the visible and the hidden checks share: the installed packages."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace
from autograder.checking.probes import installed
from autograder.checks.ch01_package_structure.support import contract


@pytest.fixture(scope="session")
def installed_dance(workspace: Workspace) -> installed.Installed:
    """The installed files of the package that the student makes."""
    return installed.inspect_package(workspace.install, contract.SQUARE_DANCE)


@pytest.fixture(scope="session")
def installed_alarm(workspace: Workspace) -> installed.Installed:
    """The installed files of the package that the student repairs."""
    return installed.inspect_package(workspace.install, contract.WALL_ALARM)
