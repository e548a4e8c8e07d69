"""A fixture of the hidden checks: a copy of the package with more files."""

from __future__ import annotations

import random

import pytest

from autograder.checking import Workspace
from autograder.checks.ch01_package_structure.support.added_files import ExtendedPackage, extend

WORDS = ("waltz", "polka", "samba", "rumba", "tango", "foxtrot")


@pytest.fixture(scope="session")
def extended(workspace: Workspace, seed: int) -> ExtendedPackage:
    """The student's package with a launch file, a configuration and a subpackage more, built again."""
    draw = random.Random(f"{seed}:grown")
    return extend(workspace, f"{draw.choice(WORDS)}_{draw.randrange(100, 1000)}")
