"""What stands in a public module of the real packages can be imported from there, or the error says what is missing."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest
import yaml
from standin_notice import NotInStandInError

MODULES: dict[str, list[str]] = yaml.safe_load(Path(__file__).with_name("real_modules.yaml").read_text())
# Modules of the real packages that nobody needs for a launch file; the stand-ins divide that code in another way.
INNER = (
    "launch.frontend.parse_substitution",
    "launch.launch_introspector",
    "launch.logging",
    "launch.utilities.type_utils",
    "launch_ros.actions.lifecycle_transition",
    "launch_ros.actions.node",
)


@pytest.mark.parametrize("module", [name for name in MODULES if not name.startswith(INNER)])
def test_a_module_offers_its_names_or_says_that_they_are_not_covered(module: str) -> None:
    for name in MODULES[module] or [""]:
        try:
            found = importlib.import_module(module)
            assert not name or getattr(found, name)
        except NotInStandInError as error:
            assert "is not covered" in str(error)  # noqa: PT017


def test_a_name_of_a_submodule_is_that_of_its_package() -> None:
    from launch.actions import GroupAction
    from launch.event_handlers import OnProcessExit

    assert importlib.import_module("launch.actions.group_action").GroupAction is GroupAction
    assert importlib.import_module("launch.event_handlers.on_process_exit").OnProcessExit is OnProcessExit


def test_what_has_no_stand_in_is_named_when_it_is_imported() -> None:
    module = importlib.import_module("launch_ros.actions.composable_node_container")
    with pytest.raises(NotInStandInError, match="ComposableNodeContainer' is not covered"):
        module.ComposableNodeContainer  # noqa: B018


def test_a_module_that_the_real_package_has_not_is_not_found() -> None:
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("launch.actions.fly")
