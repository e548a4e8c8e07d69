"""Arguments: one required, one with choices, one whose default depends on another."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("robot", description="name of the robot"),
            DeclareLaunchArgument("mode", default_value="drive", choices=["drive", "park"], description="What to do"),
            DeclareLaunchArgument("topic", default_value=["/", LaunchConfiguration("robot"), "/scan"]),
            LogInfo(msg=["mode ", LaunchConfiguration("mode"), " on ", LaunchConfiguration("topic")]),
        ]
    )
