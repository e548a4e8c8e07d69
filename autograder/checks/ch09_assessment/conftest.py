"""Fixtures of the suite: the message types and a function that starts nodes."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace
from autograder.checks.ch09_assessment.support.robot import NodeHarness, Start, Types


@pytest.fixture(scope="session")
def types(workspace: Workspace) -> Types:
    """The student's message types."""
    return Types.load(workspace)


@pytest.fixture(scope="session")
def start(workspace: Workspace, types: Types) -> Start:
    """A function that starts a node with a name and parameters, and returns its harness."""
    return lambda name, **parameters: NodeHarness(workspace, types, name, **parameters)
