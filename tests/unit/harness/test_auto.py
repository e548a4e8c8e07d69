"""A harness that chooses between stepped and real time is entered before it is used."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.harness import AutoHarness, Workspace
from autograder.ros import environment


def test_using_an_auto_harness_before_it_is_entered_is_an_error(tmp_path: Path) -> None:
    harness = AutoHarness(Workspace(tmp_path, environment.find(), tmp_path), "package", "program")
    harness.optional = frozenset({"program"})
    assert harness.optional == {"program"}
    with pytest.raises(RuntimeError, match="AutoHarness is used before it is entered"):
        harness.run(1.0)
