"""A node that runs, and an executable that the package lacks."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="fleet", executable="light", output="screen"),
            Node(package="fleet", executable="status_publisher"),
        ]
    )
