"""Fixtures of the suite: sensor processors in the harness."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.checking import Workspace
from autograder.checks.ch07_best_practices.support.robot import Processor


@pytest.fixture(scope="module")
def processor(workspace: Workspace) -> Iterator[Processor]:
    """A sensor processor that several checks share."""
    with Processor(workspace) as harness:
        yield harness


@pytest.fixture
def fresh_processor(workspace: Workspace) -> Iterator[Processor]:
    """A sensor processor that has not received a scan."""
    with Processor(workspace) as harness:
        yield harness
