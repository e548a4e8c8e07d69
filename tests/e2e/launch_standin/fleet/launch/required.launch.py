"""A required node: when it dies, the launch ends."""

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
