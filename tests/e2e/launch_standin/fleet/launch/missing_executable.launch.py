"""An executable that the package does not have, after a node that runs already."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="fleet", executable="light", output="screen"),
            Node(package="fleet", executable="status_publisher"),
        ]
    )
