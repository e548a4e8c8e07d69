"""The fixture of the suite: an examination that all checks share."""

from __future__ import annotations

import pytest

from autograder.checking import Workspace, check_of
from autograder.checks.ch06_testing.hidden.examination import Examination


@pytest.fixture(scope="session")
def examination(request: pytest.FixtureRequest, workspace: Workspace, seed: int) -> Examination:
    """The runs of the student's tests that the checks of this session need."""
    checks = (check_of(getattr(item, "function", None)) for item in request.session.items)
    return Examination(workspace, seed, frozenset(check.id for check in checks if check is not None))
