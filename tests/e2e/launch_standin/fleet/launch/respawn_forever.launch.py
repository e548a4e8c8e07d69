"""A process that dies at once and would be restarted forever, after a long pause each time."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="fleet", executable="crash", respawn=True, respawn_delay=3600.0)])
