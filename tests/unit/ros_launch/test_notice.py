"""Stand-ins say that they are stand-ins, and an error with a remedy names what they do not cover."""

from __future__ import annotations

import importlib
from pathlib import Path

import launch
import pytest
from standin_notice import NotInStandInError, not_covered
from standin_submodules import NOT_COVERED

from autograder.ros.distribution import DISTRIBUTION

PACKAGES = ("launch", "launch_ros", "launch_testing", "launch_pytest")
ADVICE = "run `make real-launch` (needs GitHub), or use a shell in which an installation of ROS 2 is sourced"


@pytest.mark.promise("it installs stand-ins written for this course", "and the course's stand-ins are used")
@pytest.mark.parametrize("name", PACKAGES)
def test_a_stand_in_says_that_it_is_one_and_how_to_get_the_real_package(name: str) -> None:
    text = " ".join((importlib.import_module(name).__doc__ or "").split())
    assert text.startswith(f"Stand-in for `{name}`")
    assert "make real-launch" in text
    assert f"ROS 2 {DISTRIBUTION.title}" in text


@pytest.mark.parametrize(
    ("module", "name", "reason"),
    [
        ("launch.frontend", "Other", ""),
        ("launch.actions", "ForLoop", ""),
        ("launch.substitutions", "ForEachVar", ""),
        ("launch.conditions", "SomethingElse", ""),
        ("launch.event_handlers", "OnSomethingElse", ""),
        ("launch.events", "Other", ""),
        ("launch.events.process", "Other", ""),
        ("launch.launch_description_sources", "Other", ""),
        ("launch.utilities", "other", ""),
        ("launch.descriptions", "Other", ""),
        ("launch_ros.actions", "LifecycleNode", ""),
        ("launch_ros.actions", "ROSTimer", ""),
        ("launch_ros.actions", "ComposableNodeContainer", "Composable nodes need C++ components"),
        ("launch_ros.actions", "LoadComposableNodes", "Composable nodes need C++ components"),
        ("launch_ros.descriptions", "ComposableNode", "Composable nodes need C++ components"),
        ("launch_ros.substitutions", "FindOther", ""),
        ("launch_ros.parameter_descriptions", "Other", ""),
        ("launch_ros.utilities", "other", ""),
        ("launch_testing", "other", ""),
        ("launch_testing.asserts", "other", ""),
        ("launch_testing.event_handlers", "Other", ""),
        ("launch_testing.markers", "other", ""),
        ("launch_testing.tools", "launch_process", ""),
        ("launch_testing.actions", "GTest", ""),
        ("launch_testing.util", "other", ""),
        ("launch_pytest", "other", ""),
        ("launch_pytest.actions", "other", ""),
        ("launch_pytest.tools", "other", ""),
        ("launch_pytest.tools.process", "other", ""),
    ],
)
def test_an_uncovered_name_is_named_with_the_way_to_get_it(module: str, name: str, reason: str) -> None:
    with pytest.raises(NotInStandInError) as excinfo:
        exec(f"from {module} import {name}")
    text = str(excinfo.value)
    package = module.partition(".")[0]
    assert text.startswith(f"'{module}.{name}' is not covered: this is the course's stand-in for {package}, ")
    assert reason in text
    assert text.endswith(f"To use '{module}.{name}', {ADVICE}.")


@pytest.mark.parametrize(
    "module", [f"{parent}.{name}" for parent, names in NOT_COVERED.items() for name in names.split()]
)
def test_an_uncovered_submodule_is_named_with_the_way_to_get_it(module: str) -> None:
    for statement in (f"import {module}", f"from {module} import Name"):
        with pytest.raises(NotInStandInError) as excinfo:
            exec(statement)
        package = module.partition(".")[0]
        assert str(excinfo.value) == str(not_covered(module, standin=package))


def test_a_misspelt_name_is_reported_with_the_nearest_one() -> None:
    with pytest.raises(
        NotInStandInError, match=r"^'launch_ros.actions.Nod' is not covered \(did you mean 'Node'\?\): "
    ):
        exec("from launch_ros.actions import Nod")


def test_a_private_name_raises_an_attribute_error() -> None:
    assert not hasattr(launch.actions, "__wrapped__")
    with pytest.raises(AttributeError, match=r"module 'launch.actions' has no attribute '_private'"):
        launch.actions._private  # noqa: B018


@pytest.mark.parametrize("tag", ["ros_timer", "node_container", "load_composable_node"])
def test_an_uncovered_element_of_a_launch_file_is_named_with_the_way_to_get_it(tag: str, tmp_path: Path) -> None:
    file = tmp_path / "robot.launch.xml"
    file.write_text(f"<launch><{tag}/></launch>")
    source = launch.launch_description_sources.AnyLaunchDescriptionSource(str(file))
    with pytest.raises(launch.InvalidLaunchFileError) as excinfo:
        source.get_launch_description(launch.LaunchContext())
    assert f"'{tag}' is not covered: this is the course's stand-in for launch_ros" in str(excinfo.value)
    assert f"To use '{tag}', {ADVICE}." in str(excinfo.value)
