"""The launch file that the chapter prints, with its indentation restored."""

import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    pkg_share = get_package_share_directory("my_robot_package")
    config_file = os.path.join(pkg_share, "config", "robot_params.yaml")  # noqa: PTH118  # as printed

    return LaunchDescription(
        [
            Node(
                package="my_robot_package",
                executable="robot_controller",
                name="robot_controller",
                parameters=[config_file],
                output="screen",
            ),
            Node(
                package="my_robot_package",
                executable="sensor_processor",
                name="sensor_processor",
                parameters=[config_file],
                output="screen",
            ),
            Node(
                package="my_robot_package",
                executable="status_publisher",
                name="status_publisher",
                parameters=[config_file],
                output="screen",
            ),
        ]
    )
