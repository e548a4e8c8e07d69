"""A node without which the rest has no use: when it dies, everything ends."""

from launch import LaunchDescription
from launch.actions import Shutdown
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription(
        [
            Node(package="fleet", executable="light", output="screen"),
            Node(package="fleet", executable="crash", name="sensor", on_exit=Shutdown(reason="the sensor is gone")),
        ]
    )
