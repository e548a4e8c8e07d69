"""A fixture of the hidden checks: a copy of the package with additional files."""

from __future__ import annotations

import random

import pytest

from autograder.checking import Workspace
from autograder.checks.ch01_package_structure.support.added_files import ExtendedPackage, extend

WORDS = ("waltz", "polka", "samba", "rumba", "tango", "foxtrot")


@pytest.fixture(scope="session")
def extended(workspace: Workspace, seed: int) -> ExtendedPackage:
    """A built copy of the student's package with an additional launch file, configuration and subpackages."""
    draw = random.Random(f"{seed}:grown")
    return extend(workspace, f"{draw.choice(WORDS)}_{draw.randrange(100, 1000)}")
