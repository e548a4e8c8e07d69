"""Fixtures of the suite: the message types, the harnesses."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace
from autograder.checks.ch09_assessment.support.robot import NodeHarness, Start, Types


@pytest.fixture(scope="session")
def types(workspace: Workspace) -> Types:
    """The student's messages."""
    return Types.of(workspace)


@pytest.fixture(scope="session")
def start(workspace: Workspace, types: Types) -> Start:
    """Return a harness of a node of this name, with these parameters, each time it is called."""
    return lambda name, **parameters: NodeHarness(workspace, types, name, **parameters)
