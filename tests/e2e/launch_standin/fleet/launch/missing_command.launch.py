"""A command that is not on the PATH, and an action that still runs."""

from launch import LaunchDescription
from launch.actions import ExecuteProcess, LogInfo


def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=["no-such-program", "-x"]), LogInfo(msg="continues")])
