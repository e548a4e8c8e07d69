"""Fixtures for the tests of the launch stand-ins: a context, a launch service and a separate log folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import launch
import pytest

# Tests of the stand-ins have nothing to test where the real packages are installed.
collect_ignore_glob = [] if (Path(launch.__file__).parents[1] / "standin_notice.py").exists() else ["test_*.py"]

Run = Callable[..., int]


@pytest.fixture(autouse=True)
def _separate_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    before = dict(os.environ)
    launch.logging.reset()
    yield
    launch.logging.reset()
    os.environ.clear()
    os.environ.update(before)


@pytest.fixture
def context() -> launch.LaunchContext:
    """A context with the launch configurations that the tests look up."""
    context = launch.LaunchContext()
    context.launch_configurations.update({"robot": "r2", "speed": "0.5", "sim": "true"})
    return context


@pytest.fixture
def run() -> Run:
    """Run entities in a launch service until they are done; return its return code."""

    def run_entities(*entities: Any) -> int:
        service = launch.LaunchService()
        service.include_launch_description(launch.LaunchDescription(entities))
        return_code: int = service.run()
        return return_code

    return run_entities


@pytest.fixture
def recorded() -> list[str]:
    """The texts that `record` has recorded."""
    return []


@pytest.fixture
def record(recorded: list[str]) -> Callable[[Any], launch.Action]:
    """Make an action that records the text of a substitution at the time of its execution."""

    def make(text: Any) -> launch.Action:
        parts = launch.utilities.normalize_to_list_of_substitutions(text)

        def write(context: launch.LaunchContext) -> None:
            recorded.append(launch.utilities.perform_substitutions(context, parts))

        return launch.actions.OpaqueFunction(function=write)

    return make
