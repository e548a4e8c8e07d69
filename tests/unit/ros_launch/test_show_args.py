"""What `ros2 launch -s` says of a launch file's arguments: the words of the real command."""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration

from autograder.ros.ros2.launch import argument_lines


def test_each_argument_is_shown_once_with_its_choices_and_its_default() -> None:
    description = LaunchDescription(
        [
            DeclareLaunchArgument("mode", default_value="drive", choices=["drive", "park"], description="What to do"),
            DeclareLaunchArgument("robot"),
            DeclareLaunchArgument("topic", default_value=[LaunchConfiguration("robot"), "/scan"], description="Where"),
        ]
    )
    assert (
        "\n".join(argument_lines(description))
        == """\
Arguments (pass arguments as '<name>:=<value>'):

    'mode':
        What to do. Valid choices are: ['drive', 'park']
        (default: 'drive')

    'robot':
        no description given

    'topic':
        Where
        (default: LaunchConfig('robot') + '/scan')"""
    )


def test_an_argument_that_is_used_on_condition_only_has_a_star() -> None:
    inner = DeclareLaunchArgument("speed", default_value="1", description="How fast")
    lines = list(argument_lines(LaunchDescription([GroupAction([inner], condition=IfCondition("true"))])))
    assert lines[1:] == [
        "\n    'speed':*",
        "        How fast",
        "        (default: '1')",
        "\n* argument(s) which are only used if specific conditions occur",
    ]


def test_a_launch_file_without_arguments_says_so() -> None:
    assert list(argument_lines(LaunchDescription([])))[1:] == ["\n  No arguments."]
