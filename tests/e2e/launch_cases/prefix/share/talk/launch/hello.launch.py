from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("who", default_value="world", description="Whom to greet"),
            DeclareLaunchArgument(
                "loud", default_value="false", description="Whether to shout", choices=["true", "false"]
            ),
            DeclareLaunchArgument("more", condition=IfCondition(LaunchConfiguration("loud"))),
            DeclareLaunchArgument("topic", default_value=[LaunchConfiguration("who"), "/scan"], description="Where"),
            LogInfo(msg=["greeting ", LaunchConfiguration("who")]),
            ExecuteProcess(cmd=["echo", "hello", LaunchConfiguration("who")], name="greeter"),
        ]
    )
