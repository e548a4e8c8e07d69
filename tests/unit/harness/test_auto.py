"""A harness that chooses its time has the attributes of a harness. Using it too early is an error."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.harness import AutoHarness, Harness, Workspace
from autograder.ros import environment


def test_the_auto_harness_has_all_attributes_of_a_harness() -> None:
    names = {name for name in vars(Harness) if not name.startswith("_")}
    assert names - set(vars(AutoHarness)) - set(AutoHarness.__annotations__) == set()


def test_using_an_auto_harness_before_it_is_entered_is_an_error(tmp_path: Path) -> None:
    harness = AutoHarness(Workspace(tmp_path, environment.find(), tmp_path), "package", "program")
    harness.optional = frozenset({"program"})
    assert harness.optional == {"program"}
    with pytest.raises(RuntimeError, match="AutoHarness is used before it is entered"):
        harness.run(1.0)
