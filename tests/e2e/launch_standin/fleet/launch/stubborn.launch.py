"""A process that ignores SIGINT and, if `very` is set, SIGTERM."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("very", default_value=""),
            Node(
                package="fleet",
                executable="stubborn",
                arguments=[LaunchConfiguration("very")],
                sigterm_timeout="0.3",
                sigkill_timeout="0.2",
                output="screen",
            ),
        ]
    )
