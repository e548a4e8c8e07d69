"""Each check of the capstone has three mutants that fail it by itself."""

from __future__ import annotations

import pytest

from autograder.author.verification.mutants import mutants
from autograder.suite import Check, suites

CAPSTONE = "08_capstone"
CHECKS = suites.hidden(CAPSTONE).checks


@pytest.mark.parametrize("check", CHECKS, ids=[check.id for check in CHECKS])
def test_each_check_fails_by_itself_in_three_flawed_versions(check: Check) -> None:
    independent = [m.id for m in mutants(CAPSTONE) if check.id in m.fails and not m.fails & set(check.dependencies)]
    assert len(independent) >= 3
