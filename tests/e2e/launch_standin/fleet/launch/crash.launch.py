"""A node that dies while another one continues."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="fleet", executable="crash", name="sensor"),
            Node(package="fleet", executable="light", output="screen"),
        ]
    )
