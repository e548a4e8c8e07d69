"""Fixtures of the suite: one examination for all checks."""

from __future__ import annotations

import pytest

from autograder.lab import Workspace
from autograder.suites.ch06_testing.examination import Examination


@pytest.fixture(scope="session")
def examination(workspace: Workspace, seed: int) -> Examination:
    """The runs of the student's tests."""
    return Examination(workspace, seed)
