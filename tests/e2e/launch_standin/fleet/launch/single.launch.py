"""A node with parameters."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("name", default_value="beacon", description="name of the node"),
            DeclareLaunchArgument("rate", default_value="4.0"),
            Node(
                package="fleet",
                executable="beacon",
                name=LaunchConfiguration("name"),
                parameters=[{"label": "42", "rate": LaunchConfiguration("rate")}],
                output="screen",
            ),
        ]
    )
