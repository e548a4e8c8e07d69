"""Each public name of the real packages can be imported from the stand-ins, or the error says that it is missing."""

from __future__ import annotations

import importlib
import re
import runpy
from pathlib import Path

import pytest
import yaml
from standin_notice import NotInStandInError

from autograder.course_paths import ROOT

MODULES: dict[str, list[str]] = yaml.safe_load(Path(__file__).with_name("real_modules.yaml").read_text())
PAGE = runpy.run_path(str(ROOT / "docs" / "platform_page.py"))
PAGE_TEXT = PAGE["current"]()
# Pytest asks a plug-in for optional names, and expects an AttributeError.
PLUGIN = "launch_pytest.plugin"


@pytest.mark.parametrize("module", [name for name in MODULES if name != PLUGIN])
def test_a_module_offers_its_names_or_the_page_says_that_they_are_not_covered(module: str) -> None:
    for name in ["", *MODULES[module]]:
        if f"{module}.{name}" in MODULES:
            continue  # a submodule is tested on its own
        try:
            imported = importlib.import_module(module)
            getattr(imported, name or "__name__")
        except NotInStandInError as error:
            missing = re.match("'(.*?)' is not covered", str(error))
            assert missing, error  # noqa: PT017
            assert f"`{missing[1]}`" in PAGE_TEXT


@pytest.mark.parametrize("module", PAGE["INTERNAL_NAMES"])
def test_each_name_listed_as_not_covered_raises_an_error_that_says_so(module: str) -> None:
    for name in PAGE["INTERNAL_NAMES"][module].split():
        if f"{module}.{name}" in MODULES:
            continue  # a submodule of this name can be imported
        with pytest.raises(NotInStandInError, match=f"'{module}.{name}' is not covered"):
            getattr(importlib.import_module(module), name)


def test_a_name_of_a_submodule_is_the_same_object_as_in_its_package() -> None:
    from launch.actions import GroupAction
    from launch.event_handlers import OnProcessExit

    assert importlib.import_module("launch.actions.group_action").GroupAction is GroupAction
    assert importlib.import_module("launch.event_handlers.on_process_exit").OnProcessExit is OnProcessExit


def test_a_class_without_a_stand_in_raises_an_error_when_it_is_used() -> None:
    module = importlib.import_module("launch_ros.actions.composable_node_container")
    with pytest.raises(NotInStandInError, match="ComposableNodeContainer' is not covered"):
        module.ComposableNodeContainer  # noqa: B018


def test_a_module_that_the_real_package_does_not_have_is_not_found() -> None:
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("launch.actions.fly")
