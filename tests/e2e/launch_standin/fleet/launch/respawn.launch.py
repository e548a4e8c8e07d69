"""A process that dies and is restarted until it succeeds."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("count"),
            Node(
                package="fleet",
                executable="crash",
                arguments=[LaunchConfiguration("count"), "3"],
                respawn=True,
                respawn_delay=0.1,
                respawn_max_retries=2,
                output="screen",
            ),
        ]
    )
