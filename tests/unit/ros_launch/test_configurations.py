"""Arguments and scopes: where each launch configuration and environment variable is visible."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import pytest
from launch import LaunchContext, LaunchDescription
from launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    GroupAction,
    OpaqueFunction,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from launch.conditions import IfCondition
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, TextSubstitution

Run = Callable[..., int]
Record = Callable[[Any], Any]
X = LaunchConfiguration("x", default="unset")


def test_a_default_is_used_and_may_refer_to_an_earlier_argument(run: Run, record: Record, recorded: list[str]) -> None:
    code = run(
        DeclareLaunchArgument("robot", default_value="r2"),
        DeclareLaunchArgument("topic", default_value=["/", LaunchConfiguration("robot"), "/scan"]),
        record(LaunchConfiguration("topic")),
    )
    assert (code, recorded) == (0, ["/r2/scan"])


def test_a_default_does_not_replace_a_value(run: Run, record: Record, recorded: list[str]) -> None:
    run(SetLaunchConfiguration("x", "given"), DeclareLaunchArgument("x", default_value="default"), record(X))
    assert recorded == ["given"]


def test_a_missing_argument_ends_the_launch_with_an_error(
    run: Run, record: Record, recorded: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    code = run(DeclareLaunchArgument("map", description="the map"), record("never"))
    out = capsys.readouterr().out
    assert (code, recorded) == (1, [])
    assert 'Required launch argument "map" (description: "the map") was not provided' in out
    assert (
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
        'Required launch argument "map" was not provided.' in out
    )


def test_a_value_outside_of_the_choices_ends_the_launch(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    code = run(SetLaunchConfiguration("mode", "fly"), DeclareLaunchArgument("mode", choices=["drive", "stop"]))
    assert code == 1
    expected = """Argument "mode" provided value "fly" is not valid. Valid options are: ['drive', 'stop']"""
    assert expected in capsys.readouterr().out


def test_a_default_outside_of_the_choices_is_refused_at_once() -> None:
    with pytest.raises(RuntimeError, match='Provided default_value "fly" is not in provided choices'):
        DeclareLaunchArgument("mode", default_value="fly", choices=["drive"])
    with pytest.raises(RuntimeError, match="Provided choices arg is empty"):
        DeclareLaunchArgument("mode", choices=[])


@pytest.mark.parametrize(
    ("arguments", "description"),
    [
        ({}, "no description given"),
        ({"description": "speed"}, "speed"),
        ({"choices": ["a", "b"]}, "One of: ['a', 'b']"),
        ({"description": "speed", "choices": ["a"]}, "speed. Valid choices are: ['a']"),
    ],
)
def test_the_description_of_an_argument_names_its_choices(arguments: dict[str, Any], description: str) -> None:
    assert DeclareLaunchArgument("x", **arguments).description == description


def test_a_configuration_set_in_a_group_ends_with_the_group(run: Run, record: Record, recorded: list[str]) -> None:
    run(
        SetLaunchConfiguration("x", "outer"),
        GroupAction([record(X), SetLaunchConfiguration("x", "inner"), record(X)]),
        record(X),
    )
    assert recorded == ["outer", "inner", "outer"]


def test_configurations_set_in_a_group_without_scope_outlive_it(run: Run, record: Record, recorded: list[str]) -> None:
    run(GroupAction([SetLaunchConfiguration("x", "inner")], scoped=False), record(X))
    assert recorded == ["inner"]


def test_a_group_without_forwarding_sees_only_its_own_configurations(
    run: Run, record: Record, recorded: list[str]
) -> None:
    y = LaunchConfiguration("y", default="unset")
    run(
        SetLaunchConfiguration("x", "outer"),
        GroupAction([record(X), record(y)], forwarding=False, launch_configurations={"y": ["from ", X]}),
        record(X),
        record(y),
    )
    assert recorded == ["unset", "from outer", "outer", "unset"]


def test_groups_can_be_nested(run: Run, record: Record, recorded: list[str]) -> None:
    run(
        GroupAction(
            [SetLaunchConfiguration("x", "1"), GroupAction([SetLaunchConfiguration("x", "2"), record(X)]), record(X)]
        ),
        record(X),
    )
    assert recorded == ["2", "1", "unset"]


def test_the_environment_of_a_group_ends_with_it(run: Run, record: Record, recorded: list[str]) -> None:
    variable = EnvironmentVariable("COURSE_X", default_value="unset")
    run(
        GroupAction([SetEnvironmentVariable("COURSE_X", "inner"), record(variable)]),
        record(variable),
        SetEnvironmentVariable(["COURSE", "_X"], TextSubstitution(text="outer")),
        record(variable),
        UnsetEnvironmentVariable("COURSE_X"),
        record(variable),
    )
    assert recorded == ["inner", "unset", "outer", "unset"]


def test_an_environment_variable_can_be_extended_at_both_ends(run: Run) -> None:
    run(
        AppendEnvironmentVariable("COURSE_PATH", "b"),
        AppendEnvironmentVariable("COURSE_PATH", "c"),
        AppendEnvironmentVariable("COURSE_PATH", "a", prepend=True),
        AppendEnvironmentVariable("COURSE_LIST", "1"),
        AppendEnvironmentVariable("COURSE_LIST", "2", separator=","),
    )
    assert os.environ["COURSE_PATH"] == "a:b:c"
    assert os.environ["COURSE_LIST"] == "1,2"


def test_a_configuration_can_be_removed(run: Run, record: Record, recorded: list[str]) -> None:
    run(SetLaunchConfiguration("x", "1"), UnsetLaunchConfiguration("x"), record(X))
    assert recorded == ["unset"]


def test_substitutions_are_performed_when_the_action_is_executed(run: Run, record: Record, recorded: list[str]) -> None:
    record_x = record(X)
    run(SetLaunchConfiguration("x", "1"), SetLaunchConfiguration("x", [X, "2"]), record_x)
    assert recorded == ["12"]


def test_an_opaque_function_gets_its_arguments_and_may_yield_actions(
    run: Run, record: Record, recorded: list[str]
) -> None:
    def function(context: LaunchContext, *args: str, key: str) -> Any:
        return [record(X.perform(context)), record([*args, key])]

    run(SetLaunchConfiguration("x", "1"), OpaqueFunction(function=function, args=["a", "b"], kwargs={"key": "c"}))
    assert recorded == ["1", "abc"]


def test_a_value_that_is_not_an_entity_is_named(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("LogInfo") == 1
    assert "expected a LaunchDescriptionEntity such as an action, got str: 'LogInfo'" in capsys.readouterr().out


def test_the_arguments_of_a_description_are_found_without_running_it() -> None:
    description = LaunchDescription(
        [
            DeclareLaunchArgument("first"),
            DeclareLaunchArgument("first", default_value="ignored"),
            GroupAction([DeclareLaunchArgument("grouped")]),
            GroupAction([DeclareLaunchArgument("guarded")], condition=IfCondition("false")),
        ]
    )
    arguments = {argument.name: argument for argument in description.get_launch_arguments()}
    assert list(arguments) == ["first", "grouped", "guarded"]
    assert arguments["first"].default_value is None
    assert [arguments[name]._conditionally_included for name in arguments] == [False, False, True]


def test_arguments_behind_a_group_that_forwards_nothing_are_not_arguments_of_the_file() -> None:
    description = LaunchDescription([GroupAction([DeclareLaunchArgument("hidden")], forwarding=False)])
    assert description.get_launch_arguments() == []
