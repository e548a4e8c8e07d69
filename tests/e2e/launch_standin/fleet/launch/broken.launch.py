"""A launch file with a mistake in it."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="fleet", executable="light", nmae="typo", parameters=config)])  # noqa: F821
