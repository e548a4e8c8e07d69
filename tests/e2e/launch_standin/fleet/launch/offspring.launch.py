"""Processes with children: a shell that waits for its child, and one that leaves it behind."""

from launch import LaunchDescription
from launch.actions import ExecuteProcess


def generate_launch_description():
    return LaunchDescription(
        [
            ExecuteProcess(cmd=["echo waiting; sleep 3600; echo not reached"], shell=True, output="screen"),
            ExecuteProcess(cmd=["sh", "-c", "sleep 3600 & echo left one behind"], output="screen"),
        ]
    )
